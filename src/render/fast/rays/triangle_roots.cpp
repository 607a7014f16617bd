#include "fast/rays/triangle_roots.h"

#include "nuvo/geometry/predicates.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/rays/triangle_roots.cpp"
#include <hwy/foreach_target.h>

#include "fast/simd/lanes.h"

// The plane form t = n . (a - o) / n . d, with the bounds of [numerics: triple product]. Products
// and sums are separate operations in the order of nuvo::dot() and nuvo::cross(); multiply-adds are
// kept for the bounds, which are made a little larger than those of the scalar stage.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

using Doubles8 = Lanes<double, 8>;

struct Vectors8 {
    Doubles8 x, y, z;

    static HWY_INLINE Vectors8 load(const double (*from)[TriangleRoots::kCount], std::size_t i) {
        return {Doubles8::load(from[0] + i), Doubles8::load(from[1] + i),
                Doubles8::load(from[2] + i)};
    }
    friend HWY_INLINE Vectors8 operator-(const Vectors8& p, const Vectors8& q) {
        return {p.x - q.x, p.y - q.y, p.z - q.z};
    }
    friend HWY_INLINE Doubles8 dot(const Vectors8& p, const Vectors8& q) {
        return p.x * q.x + p.y * q.y + p.z * q.z;
    }
};

// One component of p x q, and the sum of its terms' magnitudes.
struct CrossTerm {
    Doubles8 value;
    Doubles8 size;
    HWY_INLINE CrossTerm(const Doubles8& p, const Doubles8& q, const Doubles8& r,
                         const Doubles8& s) {
        const Doubles8 first = p * q;
        const Doubles8 second = r * s;
        value = first - second;
        size = abs(first) + abs(second);
    }
};

void find_roots(TriangleRoots& roots, std::size_t count) {
    constexpr double kShare = 0.4375 * root_tolerance();
    constexpr double kBound = gamma(9) / kShare * (1 + 0x1p-40);
    constexpr double kTiny = std::numeric_limits<double>::min() / kShare;
    roots.found = 0;
    for (std::size_t i = 0; i < count; i += 8) {
        const Vectors8 a = Vectors8::load(roots.a, i);
        const Vectors8 e1 = Vectors8::load(roots.b, i) - a;
        const Vectors8 e2 = Vectors8::load(roots.c, i) - a;
        const CrossTerm x(e1.y, e2.z, e1.z, e2.y);
        const CrossTerm y(e1.z, e2.x, e1.x, e2.z);
        const CrossTerm z(e1.x, e2.y, e1.y, e2.x);
        const Vectors8 normal{x.value, y.value, z.value};
        const Vectors8 toward = a - Vectors8::load(roots.origin, i);
        const Vectors8 d = Vectors8::load(roots.direction, i);
        const Doubles8 height = dot(normal, toward);
        const Doubles8 slope = dot(normal, d);
        const Doubles8 t = height / slope;
        const auto bound = [&](const Vectors8& v) HWY_ATTR {
            const Doubles8 sum =
                mul_add(z.size, abs(v.z), mul_add(y.size, abs(v.y), x.size * abs(v.x)));
            // Underflow adds 2^-1070 and less times each component.
            const Doubles8 reach = abs(v.x) + abs(v.y) + abs(v.z);
            return mul_add(sum, Doubles8(kBound), (reach + Doubles8(1.0)) * Doubles8(kTiny));
        };
        const auto known = (abs(height) >= bound(toward)) & (abs(slope) >= bound(d)) &
                           (t > Doubles8(detail::kSmallestRoot)) &
                           (t < Doubles8(detail::kLargestRoot));
        t.store(roots.t + i);
        roots.found |= known.bits() << i;
    }
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"

namespace nuvo {

TriangleRootStage::TriangleRootStage(InstructionSet isa)
    : find_(NUVO_FOR_ISA(resolved(isa), find_roots)) {}

}  // namespace nuvo
#endif
