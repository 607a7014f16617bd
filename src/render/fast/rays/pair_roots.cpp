#include "fast/rays/pair_roots.h"

#include "nuvo/geometry/predicates.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/rays/pair_roots.cpp"
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

    static HWY_INLINE Vectors8 load(const double (*from)[PairRoots::kCount], std::size_t i) {
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

// p x q.
struct Cross {
    CrossTerm x, y, z;
    HWY_INLINE Cross(const Vectors8& p, const Vectors8& q)
        : x(p.y, q.z, p.z, q.y), y(p.z, q.x, p.x, q.z), z(p.x, q.y, p.y, q.x) {}
    HWY_INLINE Doubles8 dot(const Vectors8& v) const {
        return x.value * v.x + y.value * v.y + z.value * v.z;
    }
    // Bounds the error of dot(v), times `by`. Underflow adds 2^-1070 and less times each component.
    HWY_INLINE Doubles8 error(const Vectors8& v, double by) const {
        const Doubles8 sum =
            mul_add(z.size, abs(v.z), mul_add(y.size, abs(v.y), x.size * abs(v.x)));
        const Doubles8 reach = abs(v.x) + abs(v.y) + abs(v.z);
        return mul_add(sum, Doubles8(by * (gamma(9) * (1 + 0x1p-40))),
                       (reach + Doubles8(1.0)) * Doubles8(by * std::numeric_limits<double>::min()));
    }
};

using PairMask = LaneMask<double, 8>;

// On which side the line passes of a triangle's edges.
struct Sides8 {
    PairMask all_positive, all_negative, any_positive, any_negative;

    HWY_INLINE Sides8(const Vectors8& d, const Vectors8& a, const Vectors8& b, const Vectors8& c)
        : Sides8(d, Cross(c, b)) {
        for (const Sides8& edge : {Sides8(d, Cross(a, c)), Sides8(d, Cross(b, a))}) {
            all_positive = all_positive & edge.all_positive;
            all_negative = all_negative & edge.all_negative;
            any_positive = any_positive | edge.any_positive;
            any_negative = any_negative | edge.any_negative;
        }
    }
    HWY_INLINE Sides8(const Vectors8& d, const Cross& edge) {
        const Doubles8 value = edge.dot(d);
        const Doubles8 error = edge.error(d, 1);
        all_positive = any_positive = value > error;
        all_negative = any_negative = value < -error;
    }
};

void find_triangle_roots(PairRoots& roots, std::size_t count) {
    constexpr double kShare = 0.4375 * root_tolerance();
    roots.found = roots.hit = roots.missed = 0;
    for (std::size_t i = 0; i < count; i += 8) {
        const Vectors8 a = Vectors8::load(roots.a, i);
        const Vectors8 b = Vectors8::load(roots.b, i);
        const Vectors8 c = Vectors8::load(roots.c, i);
        const Vectors8 o = Vectors8::load(roots.origin, i);
        const Vectors8 d = Vectors8::load(roots.direction, i);
        const Cross normal(b - a, c - a);
        const Vectors8 toward = a - o;
        const Doubles8 height = normal.dot(toward);
        const Doubles8 slope = normal.dot(d);
        const Doubles8 t = height / slope;
        const PairMask sure = (abs(height) > normal.error(toward, 1 / kShare)) &
                              (abs(slope) > normal.error(d, 1 / kShare));
        const PairMask known =
            sure & (t > Doubles8(detail::kSmallestRoot)) & (t < Doubles8(detail::kLargestRoot));
        t.store(roots.t + i);
        roots.found |= known.bits() << i;
        if (roots.only_roots) continue;
        const Sides8 sides(d, toward, b - o, c - o);
        // The edge functions add up to -n.d: of a front all are positive.
        const PairMask front = PairMask::from_bits(roots.front_only >> i & 0xff);
        const PairMask inside = sides.all_positive | without(sides.all_negative, front);
        const PairMask outside = sides.any_negative & (sides.any_positive | front);
        roots.hit |= (known & inside).bits() << i;
        roots.missed |= (outside | (sure & (t < Doubles8(0.0)))).bits() << i;
    }
}

// rounded_quadratic() and rounded_hit() of spheres that are hit, with the same bounds.
void find_sphere_roots(PairRoots& roots, std::size_t count) {
    constexpr double kShare = 0.4375 * root_tolerance();
    static_assert(gamma(6) <= kShare);  // of a
    roots.found = 0;
    for (std::size_t i = 0; i < count; i += 8) {
        const Vectors8 f = Vectors8::load(roots.origin, i) - Vectors8::load(roots.a, i);
        const Vectors8 d = Vectors8::load(roots.direction, i);
        const Doubles8 r = Doubles8::load(roots.b[0] + i);
        const Doubles8 a = dot(d, d);
        const Doubles8 length = sqrt(a);
        const Doubles8 b = dot(f, d);
        const Doubles8 along = b * (Doubles8(1.0) / a);
        const Vectors8 l{f.x - d.x * along, f.y - d.y * along, f.z - d.z * along};
        const Doubles8 ff = dot(f, f);
        const Doubles8 rr = r * r;
        const Doubles8 ll = dot(l, l);
        const Doubles8 squares = ff + rr;
        const Doubles8 f_norm = sqrt(ff);
        const Doubles8 c = ff - rr;
        const Doubles8 depth = rr - ll;
        const Doubles8 b_error = f_norm * length * Doubles8(gamma(7));
        const Doubles8 c_error = squares * Doubles8(gamma(8));
        const Doubles8 depth_error = sqrt(ll) * f_norm * Doubles8(gamma(8)) +
                                     (ll + rr) * Doubles8(gamma(8)) +
                                     ff * Doubles8(gamma(16) * gamma(32));
        const PairMask in_range = (a > Doubles8(0x1p-800)) & (a < Doubles8(0x1p800)) &
                                  (squares > Doubles8(detail::kSmallestSquare)) &
                                  (squares < Doubles8(detail::kLargestSquare));
        const PairMask inside = c < -c_error;
        const PairMask enters = (c > c_error) & (b < -b_error) & (depth > depth_error);
        // sqrt(1 + x) differs from 1 by less than 0.54 |x| for |x| < 1/4.
        const Doubles8 part = length * sqrt(depth);
        const Doubles8 relative = depth_error / depth;
        const Doubles8 part_error =
            part * (relative * Doubles8(0.5625) + Doubles8(gamma(6)) + Doubles8(gamma(4)));
        const Doubles8 sum = abs(b) + part;
        const Doubles8 sum_error = b_error + part_error + sum * Doubles8(gamma(1));
        const PairMask near = enters | (inside & (b > Doubles8(0.0)));
        const Doubles8 t = select(near, abs(c) / sum, sum / a);
        const PairMask front = PairMask::from_bits(roots.front_only >> i & 0xff);
        const PairMask known =
            in_range & (enters | without(inside, front)) & (depth > Doubles8(0.0)) &
            (relative < Doubles8(0.25)) & (sum_error <= sum * Doubles8(kShare)) &
            (c_error <= abs(c) * Doubles8(kShare)) & (t > Doubles8(detail::kSmallestRoot)) &
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

PairRootStage::PairRootStage(InstructionSet isa)
    : triangles_(NUVO_FOR_ISA(resolved(isa), find_triangle_roots)),
      spheres_(NUVO_FOR_ISA(resolved(isa), find_sphere_roots)) {}

}  // namespace nuvo
#endif
