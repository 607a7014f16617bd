// Compiled once for each instruction set by foreach_target.h, as the library's kernels are.
#define HWY_DISABLED_TARGETS HWY_SSSE3

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/color_bounds_test.cpp"
#include <hwy/foreach_target.h>

#include "fast/shading/background_lanes.h"

namespace nuvo {
#ifndef NUVO_TESTS_RENDER_COLOR_BOUNDS_TEST_CPP_
#define NUVO_TESTS_RENDER_COLOR_BOUNDS_TEST_CPP_
/// The background of one block.
struct BackgroundAnswers {
    float channel[3][kBlockLanes];
    float error[kBlockLanes];
};
#endif
}  // namespace nuvo

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

void ask_background(const ShadingTables& tables, const Tile& tile, int block,
                    BackgroundAnswers& out) {
    const PixelColors colors = background_colors(tables, BlockDirections(tables, tile, block));
    for (int c = 0; c < 3; ++c) colors.channel[c].store(out.channel[c]);
    colors.error.store(out.error);
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <cmath>
#include <memory>

#include "fast/simd/dispatch.h"
#include "fast_cases.h"
#include "nuvo/render/shading.h"

// Colors of the background and sums of light, each with its error, against doubles, and bytes at
// ties: what is said to be certain is right where a color stands as close to a tie as it can.
namespace nuvo::testing {
namespace {

constexpr unsigned kSeed = 20261161;
constexpr Resolution kPicture{64, 48};

struct Tables {
    Tables(const Scene& scene, InstructionSet isa_in)
        : isa(resolved(isa_in)),
          primitives(flatten(scene, LeafContent::kPrimitives)),
          fast(scene, primitives, OctreeType::kUniform, 1),
          camera(scene.camera, kPicture, fast.frame()),
          spheres(fast, camera, isa),
          shading(fast, camera, spheres, isa) {
        shading.fill_all(1);
    }

    InstructionSet isa;
    Primitives primitives;
    FastScene fast;
    CameraRays camera;
    CameraTables spheres;
    ShadingTables shading;
};

class BackgroundMaker {
  public:
    explicit BackgroundMaker(unsigned seed) : random_(seed) {}

    Scene scene(int kind) {
        Scene scene;
        scene.camera = camera_along({}, uniform_point(random_, 1));
        scene.camera.field_of_view_rad =
            kind % 2 != 0 ? uniform(random_, 0.5, 2.5) : std::exp2(uniform(random_, -14, -3));
        Background& b = scene.background;
        if (kind < 2) {
            b = {{color()}, {}, {color()}, {}};
        } else if (kind < 4) {  // a slope of few floats around a tie
            const double middle = (std::floor(uniform(random_, 1, 254)) + 0.5) / 255;
            const Color near{middle, middle, middle};
            b = {{near + color() * 0x1p-22}, {}, {near - color() * 0x1p-22}, {}};
        } else {
            b.sky_color = {color(), color(), color()};
            b.sky_angle = {uniform(random_, 0.1, 1), uniform(random_, 1, 2)};
            if (kind >= 6) {
                b.ground_color = {color(), color()};
                b.ground_angle = {uniform(random_, 0.2, 1.4)};
            }
        }
        if (random_() % 2 != 0) b.zenith = normalized(uniform_point(random_, 1));
        return scene;
    }

  private:
    Color color() {
        return {uniform(random_, 0, 1), uniform(random_, 0, 1), uniform(random_, 0, 1)};
    }

    std::mt19937_64 random_;
};

TEST(ColorBounds, HoldTheBackground) {
    constexpr int kKinds = 8;
    for (const InstructionSet isa : supported_instruction_sets()) {
        BackgroundMaker maker(kSeed);
        const auto ask = NUVO_FOR_ISA(isa, ask_background);
        double share[kKinds] = {};
        int known[kKinds] = {};
        int all[kKinds] = {};
        for (int round = 0; round < 400; ++round) {
            const int kind = round % kKinds;
            const Scene scene = maker.scene(kind);
            const Tables tables(scene, isa);
            const auto tile = std::make_unique<Tile>();
            tile->x = round % 4 * kTileSide;
            tile->y = round / 4 % 3 * kTileSide;
            for (int block = 0; block < kTileBlocks; ++block) {
                BackgroundAnswers found;
                ask(tables.shading, *tile, block, found);
                for (int i = 0; i < kBlockLanes; ++i) {
                    const int lane = block * kBlockLanes + i;
                    ++all[kind];
                    if (!std::isfinite(found.error[i])) continue;
                    ++known[kind];
                    const Ray ray =
                        tables.camera.rays.ray(tile->x + lane_x(lane), tile->y + lane_y(lane));
                    const Color truth = scene.background.color(ray.direction) * 255;
                    for (int c = 0; c < 3; ++c) {
                        const double error =
                            std::fabs(static_cast<double>(found.channel[c][i]) - truth[c]);
                        const auto bound = static_cast<double>(found.error[i]);
                        ASSERT_LE(error, bound + 0x1p-40)
                            << "seed " << kSeed << ", round " << round << ", lane " << lane;
                        share[kind] = std::fmax(share[kind], error / bound);
                    }
                }
            }
        }
        for (int kind = 0; kind < kKinds; ++kind) {
            EXPECT_GT(share[kind], kind < 2 ? 0.35 : kind < 4 ? 0.6 : 0.14) << "kind " << kind;
            EXPECT_GT(known[kind], all[kind] * 9 / 10) << "kind " << kind;
        }
    }
}

/// Sums of light of one tile such that a channel of each pixel stands at a tie.
class TieMaker {
  public:
    TieMaker(unsigned seed, const ShadingTables& tables, const Material& material)
        : random_(seed), tables_(tables), material_(material) {}

    /// `true_color`: what the pixel has, in 0..1.
    void put(ShadingScratch& scratch, int lane, Color& true_color) {
        const int at_tie = static_cast<int>(random_() % 3);
        const double high = uniform(random_, 0, 0.5);
        double low = uniform(random_, 0, 1);
        if (material_.diffuse_color[at_tie] > 0) {
            const double rest =
                material_.emissive_color[at_tie] + material_.specular_color[at_tie] * high;
            const double byte = std::floor(uniform(random_, rest * 255 + 1, 255)) + 0.5;
            low = (byte / 255 - rest) / material_.diffuse_color[at_tie] * (1 + off_tie());
        }
        true_color = material_.emissive_color + material_.diffuse_color * low +
                     material_.specular_color * high;
        const double extra = random_() % 2 != 0 ? 0 : std::exp2(uniform(random_, -24, -16));
        put(scratch.diffuse, scratch.diffuse_error, lane, low, extra);
        if (material_.specular_color != Color{})
            put(scratch.specular, scratch.specular_error, lane, high, extra);
    }

  private:
    double off_tie() {
        const double off = std::exp2(uniform(random_, -40, -16));
        return random_() % 2 != 0 ? off : -off;
    }
    // Off by its error, and by what finish() itself allows for the sums.
    void put(float (&sum)[3][kTileLanes], float (&error)[kTileLanes], int lane, double truth,
             double extra) {
        const double sense = random_() % 2 != 0 ? 1 : -1;
        const float known = static_cast<float>(truth + sense * extra);
        error[lane] = rounded_up(std::fabs(static_cast<double>(known) - truth));
        const double roundings = static_cast<double>(tables_.lights.size()) * 0x1p-24;
        for (auto& channel : sum)
            channel[lane] =
                static_cast<float>(static_cast<double>(known) * (1 + sense * roundings));
    }

    std::mt19937_64 random_;
    const ShadingTables& tables_;
    const Material& material_;
};

TEST(ColorBounds, HoldBytesAtTies) {
    for (const InstructionSet isa : supported_instruction_sets()) {
        ShadingKernels kernels{};
        pick_surface_kernel(isa, kernels);
        pick_finish_kernel(isa, kernels);
        std::mt19937_64 random(kSeed + 1);
        const auto color = [&](double least, double most) {
            return Color{uniform(random, least, most), uniform(random, least, most),
                         uniform(random, least, most)};
        };
        int certain = 0, open = 0;
        for (int round = 0; round < 300; ++round) {
            Scene scene;
            scene.camera = camera_along({0, 0, 1}, {0, 0, -1});
            Material material;
            material.diffuse_color = color(0.3, 1);
            if (round % 2 != 0) material.specular_color = color(0.1, 0.5);
            if (round % 3 != 0) material.emissive_color = color(0, 0.3);
            scene.materials = {material};
            if (round % 4 < 2) scene.materials.emplace_back();
            TriangleMesh mesh;
            mesh.positions = {{-9, -9, 0}, {9, -9, 0}, {0, 18, 0}};
            mesh.triangles = {{0, 1, 2}};
            if (round % 5 == 0) {  // in place of the material's
                mesh.colors.assign(3, color(0.3, 1));
                material.diffuse_color = mesh.colors[0];
            }
            Object object;
            object.shape = mesh;
            scene.objects = {object};
            scene.lights.resize(static_cast<std::size_t>(1 + round % 3));
            const Tables tables(scene, isa);
            const auto tile = std::make_unique<Tile>();
            const std::vector<Slot> slots(kTileLanes, 0);
            const std::vector<float> near(kTileLanes, 1);
            tile->slot = slots.data();
            tile->near_low = tile->near_high = near.data();
            for (int b = 0; b < kTileBlocks; ++b) tile->hit[b] = tile->inside[b] = 0xffff;
            const auto scratch = std::make_unique<ShadingScratch>();
            kernels.surface(tables.shading, *tile, *scratch);
            TieMaker ties(kSeed + 2 + static_cast<unsigned>(round), tables.shading, material);
            Color colors[kTileLanes];
            for (int lane = 0; lane < kTileLanes; ++lane) ties.put(*scratch, lane, colors[lane]);
            Image image(kPicture.width, kPicture.height);
            TileMask uncertain;
            kernels.finish(tables.shading, *tile, *scratch, image, uncertain);
            for (int lane = 0; lane < kTileLanes; ++lane) {
                if ((uncertain[lane / kBlockLanes] >> lane % kBlockLanes & 1) != 0) {
                    ++open;
                    continue;
                }
                ++certain;
                ASSERT_EQ(image.at(lane_x(lane), lane_y(lane)), quantized(colors[lane]))
                    << "seed " << kSeed + 1 << ", round " << round << ", lane " << lane;
            }
        }
        EXPECT_GT(open, 30'000);
        EXPECT_GT(certain, 10'000);
    }
}

}  // namespace
}  // namespace nuvo::testing
#endif
