#include "embree_frame.h"

#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include "embree_calls.h"
#include "embree_shading.h"

// A frame in tiles: the primary rays of a tile in square packets, then its hits light by light.

namespace nuvo::bench {
namespace {

constexpr int kTileSide = 32;
constexpr int kTilePixels = kTileSide * kTileSide;

/// Shadow rays start this part of the scene's largest coordinate away from the surface: four units
/// in the last place, which covers the rounding of a hit point in single precision.
constexpr float kBias = 0x1p-21F;

/// A packet covers a block of pixels as square as can be.
template <int N>
struct Block {
    static constexpr int kWidth = N == 16 || N == 8 ? 4 : N == 4 ? 2 : 1;
    static constexpr int kHeight = N / kWidth;
};

/// A hit with all that lighting needs.
struct LitPoint {
    Float3 point;
    Float3 normal;     // of shading
    Float3 geometric;  // unit
    Float3 to_viewer;
    Float3 color;
    std::uint32_t pixel;  // in the tile
    std::uint32_t material;
};

/// A shadow ray that has been found worth tracing.
struct ShadowRay {
    Float3 origin;
    Float3 direction;
    float distance;
    float strength;
    std::uint32_t lit;  // place among the tile's lit points
};

/// Normal and material of a hit. `hit` is its place in the packet.
template <int N>
LitPoint lit_point(const EmbreeScene& scene, const RTCRayHitNt<N>& pack, int i) {
    const FloatScene& floats = scene.floats();
    const Float3 direction{pack.ray.dir_x[i], pack.ray.dir_y[i], pack.ray.dir_z[i]};
    const Float3 origin{pack.ray.org_x[i], pack.ray.org_y[i], pack.ray.org_z[i]};
    const std::uint32_t primitive = pack.hit.primID[i];
    LitPoint lit;
    lit.point = origin + direction * pack.ray.tfar[i];
    lit.to_viewer = -direction;
    if (pack.hit.geomID[i] == scene.sphere_geometry()) {
        const std::array<float, 4>& s = floats.spheres[primitive];
        lit.normal = (lit.point - Float3{s[0], s[1], s[2]}) * (1 / s[3]);
        lit.geometric = lit.normal;
        lit.material = floats.sphere_material[primitive];
    } else {
        lit.geometric = unit(Float3{pack.hit.Ng_x[i], pack.hit.Ng_y[i], pack.hit.Ng_z[i]});
        lit.normal = lit.geometric;
        lit.material = floats.triangle_material[primitive];
        if (!floats.normals.empty()) {
            const IndexTriple& n = floats.normal_triangles[primitive];
            const float u = pack.hit.u[i];
            const float v = pack.hit.v[i];
            if (n[0] != FloatScene::kFlat)
                lit.normal = unit(floats.normals[n[0]] * (1 - u - v) + floats.normals[n[1]] * u +
                                  floats.normals[n[2]] * v);
        }
    }
    lit.color = floats.materials[lit.material].emissive;
    return lit;
}

}  // namespace

/// The buffers of one tile; every thread has one.
struct EmbreeFrame::Tile {
    int x0 = 0;
    int y0 = 0;
    int lit_count = 0;
    int shadow_count = 0;
    std::array<LitPoint, kTilePixels> lit;
    std::array<ShadowRay, kTilePixels> shadows;
    std::array<bool, kTilePixels> blocked;
};

EmbreeFrame::EmbreeFrame(const EmbreeScene& scene, Resolution resolution)
    : scene_(scene), resolution_(resolution) {
    // As RayGenerator has them, linear in the pixel.
    const Camera& camera = scene.floats().camera;
    const RayGenerator rays(camera, resolution);
    const Vector3 across = rays.step_right();
    const Vector3 down = rays.step_down();
    const Vector3 to_corner =
        across * (-0.5 * resolution.width) + down * (-0.5 * resolution.height);
    if (camera.window) {
        direction_.corner = Float3(camera.forward);
        origin_ = {Float3(rays.middle() + to_corner), Float3(across), Float3(down)};
    } else {
        direction_ = {Float3(camera.forward + to_corner), Float3(across), Float3(down)};
        origin_.corner = Float3(camera.position);
    }
    bias_ = kBias * scene.floats().largest_coordinate;
}

template <int N>
void EmbreeFrame::make_rays(int x0, int y0, RTCRayHitNt<N>& pack, std::array<int, N>& valid) const {
    for (int i = 0; i < N; ++i) {
        const int x = x0 + i % Block<N>::kWidth;
        const int y = y0 + i / Block<N>::kWidth;
        const float px = static_cast<float>(x) + 0.5F;
        const float py = static_cast<float>(y) + 0.5F;
        const Float3 from = origin_.at(px, py);
        const Float3 d = direction_.at(px, py);
        const float scale = 1 / std::sqrt(dot(d, d));
        valid[i] = x < resolution_.width && y < resolution_.height ? -1 : 0;
        pack.ray.org_x[i] = from.x;
        pack.ray.org_y[i] = from.y;
        pack.ray.org_z[i] = from.z;
        pack.ray.tnear[i] = 0;
        pack.ray.dir_x[i] = d.x * scale;
        pack.ray.dir_y[i] = d.y * scale;
        pack.ray.dir_z[i] = d.z * scale;
        pack.ray.time[i] = 0;
        pack.ray.tfar[i] = std::numeric_limits<float>::infinity();
        pack.ray.mask[i] = ~0U;
        pack.ray.flags[i] = 0;
        pack.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
}

template <int N>
void EmbreeFrame::trace_primary(Tile& tile, const EmbreeMode& mode, Depth depth,
                                Image& image) const {
    RayQuery query(mode.primary_coherent);
    alignas(64) RTCRayHitNt<N> pack;
    alignas(64) std::array<int, N> valid;
    tile.lit_count = 0;
    for (int block = 0; block < kTilePixels / N; ++block) {
        constexpr int kAcross = kTileSide / Block<N>::kWidth;
        const int x0 = tile.x0 + block % kAcross * Block<N>::kWidth;
        const int y0 = tile.y0 + block / kAcross * Block<N>::kHeight;
        if (x0 >= resolution_.width || y0 >= resolution_.height) continue;
        make_rays<N>(x0, y0, pack, valid);
        intersect<N>(valid.data(), scene_.handle(), query, pack);
        if (depth == Depth::kPrimary) continue;
        for (int i = 0; i < N; ++i) {
            if (valid[i] == 0) continue;
            const int x = x0 + i % Block<N>::kWidth;
            const int y = y0 + i / Block<N>::kWidth;
            if (pack.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) {
                LitPoint& lit = tile.lit[tile.lit_count++];
                lit = lit_point<N>(scene_, pack, i);
                lit.pixel = (y - tile.y0) * kTileSide + (x - tile.x0);
            } else if (depth == Depth::kWhole) {
                image.at(x, y) = to_bytes(background(scene_.floats(), pack.ray.dir_y[i]));
            }
        }
    }
}

template <int N>
void EmbreeFrame::trace_shadow_packets(Tile& tile, const EmbreeMode& mode) const {
    RayQuery query(mode.shadow_coherent);
    alignas(64) RTCRayNt<N> pack;
    alignas(64) std::array<int, N> valid;
    for (int first = 0; first < tile.shadow_count; first += N) {
        for (int i = 0; i < N; ++i) {
            const bool used = first + i < tile.shadow_count;
            const ShadowRay& ray = tile.shadows[used ? first + i : first];
            valid[i] = used ? -1 : 0;
            pack.org_x[i] = ray.origin.x;
            pack.org_y[i] = ray.origin.y;
            pack.org_z[i] = ray.origin.z;
            pack.tnear[i] = 0;
            pack.dir_x[i] = ray.direction.x;
            pack.dir_y[i] = ray.direction.y;
            pack.dir_z[i] = ray.direction.z;
            pack.time[i] = 0;
            pack.tfar[i] = ray.distance;
            pack.mask[i] = ~0U;
            pack.flags[i] = 0;
        }
        occluded<N>(valid.data(), scene_.handle(), query, pack);
        for (int i = 0; i < N && first + i < tile.shadow_count; ++i)
            tile.blocked[first + i] = pack.tfar[i] < 0;
    }
}

namespace {

/// The shadow rays of one light that are worth tracing.
int collect_shadow_rays(const FloatScene& scene, const FloatLight& light, float bias,
                        const LitPoint* lit, int lit_count, ShadowRay* shadows) {
    int count = 0;
    for (int i = 0; i < lit_count; ++i) {
        const LitPoint& at = lit[i];
        const FloatSample seen = sample(light, at.point);
        if (!(seen.strength > 0)) continue;
        if (!adds_light(light, scene.materials[at.material], dot(at.normal, seen.to_light)))
            continue;
        const float side = dot(at.geometric, seen.to_light) < 0 ? -bias : bias;
        shadows[count++] = {at.point + at.geometric * side, seen.to_light, seen.distance,
                            seen.strength, static_cast<std::uint32_t>(i)};
    }
    return count;
}

}  // namespace

void EmbreeFrame::trace_shadows(Tile& tile, const EmbreeMode& mode) const {
    switch (mode.shadow_width) {
        case 1:
            return trace_shadow_packets<1>(tile, mode);
        case 4:
            return trace_shadow_packets<4>(tile, mode);
        case 8:
            return trace_shadow_packets<8>(tile, mode);
        default:
            return trace_shadow_packets<16>(tile, mode);
    }
}

void EmbreeFrame::add_light(Tile& tile, const FloatLight& light) const {
    const FloatScene& floats = scene_.floats();
    for (int i = 0; i < tile.shadow_count; ++i) {
        if (tile.blocked[i]) continue;
        const ShadowRay& ray = tile.shadows[i];
        LitPoint& at = tile.lit[ray.lit];
        at.color += contribution(light, floats.materials[at.material], at.normal, ray.direction,
                                 at.to_viewer, ray.strength);
    }
}

void EmbreeFrame::render_tile(Tile& tile, const EmbreeMode& mode, Depth depth, Image& image) const {
    switch (mode.primary_width) {
        case 1:
            trace_primary<1>(tile, mode, depth, image);
            break;
        case 4:
            trace_primary<4>(tile, mode, depth, image);
            break;
        case 8:
            trace_primary<8>(tile, mode, depth, image);
            break;
        default:
            trace_primary<16>(tile, mode, depth, image);
    }
    if (depth == Depth::kPrimary) return;
    const FloatScene& floats = scene_.floats();
    for (const FloatLight& light : floats.lights) {
        tile.shadow_count = collect_shadow_rays(floats, light, bias_, tile.lit.data(),
                                                tile.lit_count, tile.shadows.data());
        tile.blocked.fill(false);
        if (light.casts_shadow) trace_shadows(tile, mode);
        if (depth == Depth::kWhole) add_light(tile, light);
    }
    if (depth != Depth::kWhole) return;
    for (int i = 0; i < tile.lit_count; ++i) {
        const LitPoint& at = tile.lit[i];
        const int pixel = static_cast<int>(at.pixel);
        image.at(tile.x0 + pixel % kTileSide, tile.y0 + pixel / kTileSide) = to_bytes(at.color);
    }
}

Image EmbreeFrame::render(const EmbreeMode& mode, Depth depth, int threads) const {
    Image image(resolution_.width, resolution_.height);
    const int across = (resolution_.width + kTileSide - 1) / kTileSide;
    const int tiles = across * ((resolution_.height + kTileSide - 1) / kTileSide);
    std::atomic<int> next{0};
    const auto work = [&] {
        const FlushDenormals flush;
        const auto tile = std::make_unique<Tile>();
        for (int i = next++; i < tiles; i = next++) {
            tile->x0 = i % across * kTileSide;
            tile->y0 = i / across * kTileSide;
            render_tile(*tile, mode, depth, image);
        }
    };
    std::vector<std::jthread> helpers;
    for (int i = 1; i < threads; ++i) helpers.emplace_back(work);
    work();
    helpers.clear();
    return image;
}

}  // namespace nuvo::bench
