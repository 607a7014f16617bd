#include "fast/shading_facing.h"

#include <limits>

#include "nuvo/math/error_bounds.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/shading_facing.cpp"
#include <hwy/foreach_target.h>

#include "fast/lanes.h"

// Normals of triangles and what they say about each light, in double, 8 triangles at a time.
//
// surface_point() takes the normal from the product of two edges in double where its error gamma(4)
// |e1| x |e2| is small, else from something better. Here that error has to stay below 2^-36 of the
// product itself (2^15 bounds the magnitudes' sum, gamma(4) < 2^-50.9), so both are within
// kTriangleNormalError of the true direction; other triangles get NaN, and their pixels the
// referee.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

inline constexpr std::size_t kBatch = 8;
using Wide = Lanes<double, kBatch>;

constexpr double kMagnitudes = 0x1p15;
// Squares of smaller products may be subnormal.
constexpr double kSmallestSquare = 0x1p-900;

struct Wide3 {
    Wide x, y, z;
};
HWY_INLINE Wide3 operator-(const Wide3& a, const Wide3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE Wide3 operator*(const Wide3& a, const Wide& s) { return {a.x * s, a.y * s, a.z * s}; }
HWY_INLINE Wide dot(const Wide3& a, const Wide3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
HWY_INLINE Wide norm1(const Wide3& a) { return abs(a.x) + abs(a.y) + abs(a.z); }
HWY_INLINE Wide3 wide(const Vector3& v) { return {Wide(v.x), Wide(v.y), Wide(v.z)}; }

struct Batch {
    double corner[9][kBatch] = {};
    double two_sided[kBatch] = {};  // 1: not solid
};

class TriangleFiller {
  public:
    explicit TriangleFiller(ShadingTables& tables)
        : tables_(tables), scale_(tables.scene.frame().scale) {}

    void run() {
        const FastScene& scene = tables_.scene;
        Batch batch;
        std::size_t filled = 0;
        std::uint32_t object = ~0U;
        const TriangleMesh* mesh = nullptr;
        SurfaceWord word = 0;
        bool two_sided = false;
        for (Slot slot = 0; slot < scene.triangle_end(); ++slot) {
            const PrimitiveSource& source = scene.source(slot);
            if (source.object != object) {
                object = source.object;
                const Object& shown = scene.scene().objects[object];
                mesh = &std::get<TriangleMesh>(shown.shape);
                word = surface_word(tables_, shown);
                two_sided = !shown.solid;
            }
            if (!tables_.triangle_words.empty()) tables_.triangle_words[slot] = word;
            const IndexTriple& corners = mesh->triangles[source.triangle];
            for (std::size_t i = 0; i < 3; ++i)
                for (int axis = 0; axis < 3; ++axis)
                    batch.corner[i * 3 + static_cast<std::size_t>(axis)][filled] =
                        mesh->positions[corners[i]][axis];
            batch.two_sided[filled] = two_sided ? 1 : 0;
            if (++filled == kBatch) {
                take(batch, slot + 1 - static_cast<Slot>(kBatch), kBatch);
                filled = 0;
            }
        }
        if (filled != 0) take(batch, scene.triangle_end() - static_cast<Slot>(filled), filled);
    }

  private:
    static HWY_INLINE Wide3 corner(const Batch& batch, std::size_t i) {
        return {Wide::load(batch.corner[3 * i]), Wide::load(batch.corner[3 * i + 1]),
                Wide::load(batch.corner[3 * i + 2])};
    }

    void take(const Batch& batch, Slot first, std::size_t count) {
        const Wide3 a = corner(batch, 0);
        const Wide scale(scale_);
        const Wide3 e1 = (corner(batch, 1) - a) * scale;
        const Wide3 e2 = (corner(batch, 2) - a) * scale;
        Wide3 n{e1.y * e2.z - e1.z * e2.y, e1.z * e2.x - e1.x * e2.z, e1.x * e2.y - e1.y * e2.x};
        const Wide magnitudes = abs(e1.y * e2.z) + abs(e1.z * e2.y) + abs(e1.z * e2.x) +
                                abs(e1.x * e2.z) + abs(e1.x * e2.y) + abs(e1.y * e2.x);
        const Wide square = dot(n, n);
        auto known = (magnitudes < norm1(n) * Wide(kMagnitudes)) & (square > Wide(kSmallestSquare));
        n = n * (Wide(1.0) / sqrt(square));
        // The side that the camera is on, seen from every point of the triangle.
        const Wide3 from_camera = (a - wide(tables_.scene.scene().camera.position)) * scale;
        const Wide side = dot(n, from_camera);
        const auto two_sided = Wide::load(batch.two_sided) > Wide(0.0);
        const Wide reach = norm1(from_camera) + norm1(e1) + norm1(e2);
        known = known & ((abs(side) > reach * Wide(4 * kTriangleNormalError)) | ~two_sided);
        Wide sign = select((side > Wide(0.0)) & two_sided, Wide(-1.0), Wide(1.0));
        sign = select(known, sign, Wide(std::numeric_limits<double>::quiet_NaN()));
        n = n * sign;
        store(n, a, first, count);
    }

    HWY_INLINE void store(const Wide3& n, const Wide3& a, Slot first, std::size_t count) {
        for (std::size_t i = 0; i < tables_.lights.size(); ++i) {
            ShadingLight& light = tables_.lights[i];
            if (light.facing.empty()) continue;
            const Light& exact = tables_.scene.scene().lights[i];
            const Wide gain(light.exact_gain);
            const Wide value = light.directional
                                   ? dot(n, wide(-exact.direction)) * gain
                                   : dot(n, (wide(exact.location) - a) * Wide(scale_)) * gain;
            put(value, light.facing.data() + first, 1, count);
        }
        if (tables_.normals.empty()) return;
        float* normals = tables_.normals.data() + 4 * static_cast<std::size_t>(first);
        put(n.x, normals, 4, count);
        put(n.y, normals + 1, 4, count);
        put(n.z, normals + 2, 4, count);
    }

    static HWY_INLINE void put(const Wide& v, float* to, std::size_t stride, std::size_t count) {
        double values[kBatch];
        v.store(values);
        for (std::size_t i = 0; i < count; ++i) to[i * stride] = static_cast<float>(values[i]);
    }

    ShadingTables& tables_;
    double scale_;
};

void fill_triangles_in(ShadingTables& tables) { TriangleFiller(tables).run(); }

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/dispatch.h"

namespace nuvo {

void fill_triangles(ShadingTables& tables, InstructionSet isa) {
    (NUVO_FOR_ISA(isa, fill_triangles_in))(tables);
}

}  // namespace nuvo
#endif
