#include "fast/shadow_planes.h"

#include <cstring>

#include "nuvo/math/error_bounds.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/shadow_planes.cpp"
#include <hwy/foreach_target.h>

#include "fast/lanes.h"

// Eight triangles at a time in double. With the light at l / h, v = h a - l and edges e1 = b - a,
// e2 = c - a: the plane through light and edge e is e x v, the triangle's own e1 x e2, and
// K = -(e1 x e2).v tells by its sign on which side the light stands.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

using Numbers = Lanes<double, 8>;

struct DoubleVectors {
    Numbers x, y, z;

    HWY_INLINE DoubleVectors operator-(const DoubleVectors& b) const {
        return {x - b.x, y - b.y, z - b.z};
    }
    HWY_INLINE DoubleVectors operator*(const Numbers& s) const { return {x * s, y * s, z * s}; }
    HWY_INLINE Numbers norm1() const { return abs(x) + abs(y) + abs(z); }
    HWY_INLINE Numbers dot(const DoubleVectors& b) const { return x * b.x + y * b.y + z * b.z; }
    HWY_INLINE DoubleVectors cross(const DoubleVectors& b) const {
        return {y * b.z - z * b.y, z * b.x - x * b.z, x * b.y - y * b.x};
    }
    static HWY_INLINE DoubleVectors all(const Vector3& v) {
        return {Numbers(v.x), Numbers(v.y), Numbers(v.z)};
    }
    static HWY_INLINE DoubleVectors load(const double (*from)[8]) {
        return {Numbers::load(from[0]), Numbers::load(from[1]), Numbers::load(from[2])};
    }
};

constexpr std::size_t kBatch = 8;

/// The corners of a batch, by component.
struct alignas(64) Corners {
    double a[3][kBatch];
    double b[3][kBatch];
    double c[3][kBatch];

    HWY_INLINE void put(std::size_t i, const Point3& pa, const Point3& pb, const Point3& pc) {
        for (int axis = 0; axis < 3; ++axis) {
            a[axis][i] = pa[axis];
            b[axis][i] = pb[axis];
            c[axis][i] = pc[axis];
        }
    }
};

class PlanesMaker {
  public:
    explicit PlanesMaker(const ShadowPlanesJob& job)
        : job_(job),
          center_(DoubleVectors::all(job.scene.frame().center)),
          toward_(DoubleVectors::all(job.light.toward)),
          scale_(job.scene.frame().scale),
          weight_(job.light.weight),
          size_(job.light.weight * job.reach + max_norm(job.light.toward)) {}

    void run() {
        const FastScene& scene = job_.scene;
        std::size_t filled = 0;
        Slot start = job_.first;
        for (Slot slot = job_.first; slot < job_.last; ++slot) {
            const PrimitiveSource& source = scene.source(slot);
            const auto& mesh =
                *std::get_if<TriangleMesh>(&scene.scene().objects[source.object].shape);
            const IndexTriple& v = mesh.triangles[source.triangle];
            corners_.put(filled, mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]);
            if (++filled < kBatch) continue;
            make(start, kBatch);
            start = slot + 1;
            filled = 0;
        }
        if (filled > 0) make(start, filled);
    }

  private:
    // A plane is kept where its normal's relative error is at most this, a quarter of a float's
    // roundoff: the plane then lies within half a float roundoff of its place in the scene.
    static constexpr double kShare = 0x1p-26;
    // Edges have one rounding, v at most four of size_; a component of their product two products
    // of these, and a difference: 2 (1 + 4 + 1) + 2 roundings; three components; a few to spare.
    static constexpr double kNormalError = 48 * kUnitRoundoff;
    // K sums three such components against v, which has four roundings and three more of the sum.
    static constexpr double kSideError = 2 * kNormalError;
    static constexpr double kSmallest = 0x1p-900;  // nothing above has lost to underflow

    void make(Slot first, std::size_t count) {
        for (std::size_t i = count; i < kBatch; ++i)
            for (auto* corner : {corners_.a, corners_.b, corners_.c})
                for (int axis = 0; axis < 3; ++axis) corner[axis][i] = corner[axis][0];
        const DoubleVectors a = DoubleVectors::load(corners_.a);
        const DoubleVectors b = DoubleVectors::load(corners_.b);
        const DoubleVectors c = DoubleVectors::load(corners_.c);
        const DoubleVectors e1 = (b - a) * scale_;
        const DoubleVectors e2 = (c - a) * scale_;
        const DoubleVectors e3 = (c - b) * scale_;
        const DoubleVectors local_a = (a - center_) * scale_;
        const DoubleVectors local_b = (b - center_) * scale_;
        const DoubleVectors from_a = local_a * weight_ - toward_;
        const DoubleVectors from_b = local_b * weight_ - toward_;
        const DoubleVectors normal = e1.cross(e2);
        const Numbers side = signs(count, normal.dot(from_a), e1.norm1() * e2.norm1());
        put(0, e1.cross(from_a), side, local_a, e1.norm1() * size_);
        put(1, from_a.cross(e2), side, local_a, e2.norm1() * size_);
        put(2, e3.cross(from_b), side, local_b, e3.norm1() * size_);
        put(3, normal, Numbers(0.0) - side, local_a, e1.norm1() * e2.norm1());
        write(job_.out + first, count);
    }

    // Of each plane, four components of eight triangles become eight times four.
    HWY_INLINE void write(ShadowPlanes* out, std::size_t count) {
        using Tag = LaneShape<float, 4>::Tag;
        constexpr std::size_t kWidth = LaneShape<float, 4>::kPart;
        alignas(64) float planes[4 * kBatch];
        for (int p = 0; p < 4; ++p) {
            const auto& made = made_[p];
            for (std::size_t i = 0; i < kBatch; i += kWidth)
                hn::StoreInterleaved4(hn::Load(Tag(), made[0] + i), hn::Load(Tag(), made[1] + i),
                                      hn::Load(Tag(), made[2] + i), hn::Load(Tag(), made[3] + i),
                                      Tag(), planes + 4 * i);
            for (std::size_t i = 0; i < count; ++i)
                std::memcpy(out[i].plane[p], planes + 4 * i, sizeof out[i].plane[p]);
        }
        // Where the light lies in the plane nothing is hidden from it.
        for (std::size_t i = 0; i < count; ++i)
            if (sides_[i] == 0) out[i].plane[3][3] = -1;
    }

    // 1 where the light is on the side that the normal points to, -1 or 0: of -n.v.
    HWY_INLINE Numbers signs(std::size_t count, const Numbers& nv, const Numbers& edges) {
        const Numbers bound = edges * (size_ * Numbers(kSideError)) + Numbers(kSmallest);
        const auto sure = abs(nv) > bound;
        const Numbers rounded = select(nv > Numbers(0.0), Numbers(-1.0), Numbers(1.0));
        rounded.store(sides_);
        for (std::uint32_t open = ~sure.bits() & ((1U << count) - 1); open != 0; open &= open - 1)
            decide(static_cast<unsigned>(std::countr_zero(open)));
        return Numbers::load(sides_);
    }
    HWY_NOINLINE void decide(unsigned i) {
        const auto corner = [i](const double(*from)[kBatch]) {
            return Point3{from[0][i], from[1][i], from[2][i]};
        };
        sides_[i] = exact_light_side(job_.exact_light,
                                     {corner(corners_.a), corner(corners_.b), corner(corners_.c)});
    }

    HWY_INLINE void put(int p, const DoubleVectors& normal, const Numbers& sign,
                        const DoubleVectors& on_it, const Numbers& magnitude) {
        const Numbers norm = normal.norm1();
        const auto known = (norm > magnitude * Numbers(kNormalError / kShare)) &
                           (norm > Numbers(kSmallest)) & (norm < Numbers(1 / kSmallest));
        const Numbers factor = select(known, sign / norm, Numbers(0.0));
        const DoubleVectors n = DoubleVectors{select(known, normal.x, Numbers(0.0)),
                                              select(known, normal.y, Numbers(0.0)),
                                              select(known, normal.z, Numbers(0.0))} *
                                factor;
        store_rounded(n.x, made_[p][0]);
        store_rounded(n.y, made_[p][1]);
        store_rounded(n.z, made_[p][2]);
        store_rounded(-n.dot(on_it), made_[p][3]);
    }
    static HWY_INLINE void store_rounded(const Numbers& v, float* to) {
        for (std::size_t i = 0; i < Numbers::Shape::kParts; ++i) {
            const hn::Rebind<float, Numbers::Tag> tag;
            hn::StoreU(hn::DemoteTo(tag, v.part[i]), tag, to + i * Numbers::Shape::kPart);
        }
    }

    const ShadowPlanesJob& job_;
    DoubleVectors center_;
    DoubleVectors toward_;
    Numbers scale_;
    Numbers weight_;
    Numbers size_;  // bounds |v|
    Corners corners_;
    alignas(64) double sides_[kBatch];
    alignas(64) float made_[4][4][kBatch];  // by plane, component, triangle
};

void make_planes(const ShadowPlanesJob& job) { PlanesMaker(job).run(); }

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/dispatch.h"
#include "nuvo/math/exact.h"

namespace nuvo {

void make_shadow_planes(const ShadowPlanesJob& job, InstructionSet isa) {
    (NUVO_FOR_ISA(isa, make_planes))(job);
}

int exact_light_side(const Light& light, const Triangle& triangle) {
    const ExactVector a(triangle.a);
    const ExactVector normal = cross(ExactVector(triangle.b) - a, ExactVector(triangle.c) - a);
    if (light.kind == Light::Kind::kDirectional)
        return dot(normal, ExactVector(-light.direction)).sign();
    return dot(normal, ExactVector(light.location) - a).sign();
}

}  // namespace nuvo
#endif
