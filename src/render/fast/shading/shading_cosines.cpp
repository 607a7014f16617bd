#include "fast/shading/shading_tables.h"

#include <cstring>
#include <limits>

#include "nuvo/math/error_bounds.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/shading/shading_cosines.cpp"
#include <hwy/foreach_target.h>

#include "fast/shading/wide_triangles.h"
#include "fast/simd/wide_vectors.h"

// Normals of triangles and what they say about each light, in double, 8 triangles at a time.
//
// surface_point() takes the normal from the product of two edges in double where its error gamma(4)
// |e1| x |e2| is small, else from something better. Here that error has to stay below 2^-36 of the
// product itself (2^15 bounds the magnitudes' sum, gamma(4) < 2^-50.9), so both are within
// kTriangleNormalError of the true direction; other triangles get NaN, and their pixels the
// fallback.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

constexpr double kMagnitudes = 0x1p15;
// Bounds that error and the length's roundings in units of the magnitudes' sum over the product.
constexpr double kNormalShare = 0x1p-48;
// Squares of smaller products may be subnormal.
constexpr double kSmallestSquare = 0x1p-900;

/// What is known of a batch's triangles beside their corners.
struct Surfaces {
    double normal[9][kBatch] = {};        // of smooth triangles
    double two_sided[kBatch] = {};        // 1: not solid
    SmoothTriangle* smooth[kBatch] = {};  // null: flat
    bool any_smooth = false;
};

class TriangleFiller {
  public:
    explicit TriangleFiller(ShadingTables& tables)
        : tables_(tables),
          scale_(tables.scene.frame().scale),
          plane_error_(plane_error(tables.scene.frame())) {}

    void run(const TriangleChunk& chunk) {
        const FastScene& scene = tables_.scene;
        std::uint32_t object = ~0U;
        chunk.for_each_batch(
            [&](const TriangleBatch& batch, Slot place, std::size_t count) HWY_ATTR {
                const Slot first = chunk.slots[place];  // lists are of whole batches (TriangleSet)
                for (std::size_t lane = 0; lane < count; ++lane) {
                    const PrimitiveSource& source = scene.source(first + static_cast<Slot>(lane));
                    if (source.object != object) {
                        object = source.object;
                        enter(object);
                    }
                    put(first + static_cast<Slot>(lane), source.triangle, lane);
                }
                take(batch, first, count);
            });
    }

  private:
    static constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

    void enter(std::uint32_t object) {
        const Object& shown = tables_.scene.scene().objects[object];
        mesh_ = &std::get<TriangleMesh>(shown.shape);
        word_ = tables_.word_of(shown);
        two_sided_ = !shown.solid;
        offset_ = mesh_->normals.empty() ? 0 : tables_.triangles.smooth_offsets[object];
    }

    HWY_INLINE void put(Slot slot, std::uint32_t index, std::size_t lane) {
        if (!tables_.triangles.words.empty()) tables_.triangles.words[slot] = word_;
        surfaces_.two_sided[lane] = two_sided_ ? 1 : 0;
        surfaces_.smooth[lane] = nullptr;
        if (mesh_->normals.empty()) return;
        const auto& corners =
            mesh_->normal_triangles.empty() ? mesh_->triangles : mesh_->normal_triangles;
        for (std::size_t i = 0; i < 3; ++i)
            for (int axis = 0; axis < 3; ++axis)
                surfaces_.normal[i * 3 + static_cast<std::size_t>(axis)][lane] =
                    mesh_->normals[corners[index][i]][axis];
        surfaces_.smooth[lane] = &tables_.triangles.smooth[slot - offset_];
        surfaces_.any_smooth = true;
    }

    HWY_INLINE void take(const TriangleBatch& batch, Slot first, std::size_t count) {
        const Wide3 a = Wide3::load(batch.corner);
        const Wide scale(scale_);
        WideTriangles t;
        const CameraRays& camera = tables_.camera;
        t.a = (a - Wide3::all(camera.anchor)) * scale;
        t.from = camera.parallel ? Wide3::all(camera.forward) : t.a;
        t.e1 = (Wide3::load(batch.corner + 3) - a) * scale;
        t.e2 = (Wide3::load(batch.corner + 6) - a) * scale;
        Wide3 n = cross(t.e1, t.e2);
        const Wide magnitudes = abs(t.e1.y * t.e2.z) + abs(t.e1.z * t.e2.y) + abs(t.e1.z * t.e2.x) +
                                abs(t.e1.x * t.e2.z) + abs(t.e1.x * t.e2.y) + abs(t.e1.y * t.e2.x);
        const Wide square = dot(n, n);
        const Wide norm1_of_n = norm1(n);
        const Wide edges = norm1(t.e1) + norm1(t.e2);
        plane_off_ = edges * magnitudes * Wide(kNormalShare) / norm1_of_n;
        auto known =
            (magnitudes < norm1_of_n * Wide(kMagnitudes)) & (square > Wide(kSmallestSquare));
        n = n * (Wide(1.0) / sqrt(square));
        // The side that the camera is on, seen from every point of the triangle.
        const Wide side = dot(n, t.from);
        const Wide reach = camera.parallel ? norm1(t.from) : norm1(t.from) + edges;
        const auto sided = known & (abs(side) > reach * Wide(4 * kTriangleNormalError));
        const auto two_sided = Wide::load(surfaces_.two_sided) > Wide(0.0);
        const auto behind = side > Wide(0.0);
        known = sided | (known & ~two_sided);
        const Wide one(1.0);
        const Wide unknown(kNotKnown);
        const Wide turned = select(behind & two_sided, -one, one);
        store(n * select(known, turned, unknown), a, first, count);
        if (!surfaces_.any_smooth) return;
        const Wide sign = select(sided, select(behind, -turned, turned), unknown);
        store_smooth(t, sign, count);
        surfaces_.any_smooth = false;
    }

    HWY_INLINE void store(const Wide3& n, const Wide3& a, Slot first, std::size_t count) {
        for (std::size_t i = 0; i < tables_.lights.size(); ++i) {
            const ShadingLight& light = tables_.lights[i];
            BigVector<float>& cosines = tables_.triangles.cosines[i];
            if (cosines.empty()) continue;
            const Light& exact = tables_.scene.scene().lights[i];
            const Wide value =
                light.directional
                    ? dot(n, Wide3::all(-exact.direction))
                    : within_plane_error(dot(n, (Wide3::all(exact.location) - a) * Wide(scale_)));
            spread(value * Wide(light.exact_gain), cosines.data() + first, 1, count);
        }
        if (tables_.triangles.normals.empty()) return;
        float* normals = tables_.triangles.normals.data() + 4 * static_cast<std::size_t>(first);
        spread(n.x, normals, 4, count);
        spread(n.y, normals + 1, 4, count);
        spread(n.z, normals + 2, 4, count);
    }
    // n.(L - a), NaN where the plane is off by more than plane_error() allows.
    HWY_INLINE Wide within_plane_error(const Wide& distance) const {
        const Wide most = abs(distance) * Wide(0.5 * kFloatRoundoff) + Wide(plane_error_);
        return select(plane_off_ <= most, distance, Wide(kNotKnown));
    }
    static HWY_INLINE void spread(const Wide& v, float* to, std::size_t stride, std::size_t count) {
        if (stride == 1 && count == kBatch) {
            store_rounded(v, to);
            return;
        }
        float values[kBatch];
        store_rounded(v, values);
        for (std::size_t i = 0; i < count; ++i) to[i * stride] = values[i];
    }

    HWY_INLINE void store_smooth(const WideTriangles& t, const Wide& sign, std::size_t count) {
        float functions[SmoothTriangle::kNumbers][kBatch];
        smooth_functions(tables_.camera, static_cast<double>(tables_.rays.longest), t,
                         Wide3::load(surfaces_.normal), Wide3::load(surfaces_.normal + 3),
                         Wide3::load(surfaces_.normal + 6), sign, functions);
        for (std::size_t i = 0; i < count; ++i) {
            if (surfaces_.smooth[i] == nullptr) continue;
            float numbers[SmoothTriangle::kNumbers];
            for (std::size_t k = 0; k < SmoothTriangle::kNumbers; ++k) numbers[k] = functions[k][i];
            std::memcpy(surfaces_.smooth[i], numbers, sizeof numbers);
        }
    }

    ShadingTables& tables_;
    double scale_;
    double plane_error_;
    Wide plane_off_;  // bounds how far the batch's planes are off at their triangles' points
    Surfaces surfaces_;
    // The object that the next triangles belong to.
    const TriangleMesh* mesh_ = nullptr;
    SurfaceWord word_ = 0;
    bool two_sided_ = false;
    std::uint32_t offset_ = 0;
};

void fill_triangles(ShadingTables& tables, const TriangleChunk& chunk) {
    TriangleFiller(tables).run(chunk);
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"

namespace nuvo {

void ShadingTables::take(const TriangleChunk& chunk) {
    (NUVO_FOR_ISA(isa, fill_triangles))(*this, chunk);
}

}  // namespace nuvo
#endif
