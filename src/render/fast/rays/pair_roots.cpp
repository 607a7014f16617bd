#include "fast/rays/pair_roots.h"

#include "nuvo/geometry/predicates.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/rays/pair_roots.cpp"
#include <hwy/foreach_target.h>

#include "fast/simd/wide_vectors.h"

// The plane form t = n . (a - o) / n . d, with the bounds of [numerics: triple product]. Products
// and sums are separate operations in the order of nuvo::dot() and nuvo::cross(); multiply-adds are
// kept for the bounds, which are made a little larger than those of the scalar stage.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

// One component of p x q, and the sum of its terms' magnitudes.
struct CrossTerm {
    Wide value;
    Wide size;
    HWY_INLINE CrossTerm(const Wide& p, const Wide& q, const Wide& r, const Wide& s) {
        const Wide first = p * q;
        const Wide second = r * s;
        value = first - second;
        size = abs(first) + abs(second);
    }
};

// p x q.
struct Cross {
    CrossTerm x, y, z;
    HWY_INLINE Cross(const Wide3& p, const Wide3& q)
        : x(p.y, q.z, p.z, q.y), y(p.z, q.x, p.x, q.z), z(p.x, q.y, p.y, q.x) {}
    HWY_INLINE Wide dot(const Wide3& v) const {
        return x.value * v.x + y.value * v.y + z.value * v.z;
    }
    // Bounds the error of dot(v), times `by`. Underflow adds 2^-1070 and less times each component.
    HWY_INLINE Wide error(const Wide3& v, double by) const {
        const Wide sum = mul_add(z.size, abs(v.z), mul_add(y.size, abs(v.y), x.size * abs(v.x)));
        const Wide reach = norm1(v);
        return mul_add(sum, Wide(by * (gamma(9) * (1 + 0x1p-40))),
                       (reach + Wide(1.0)) * Wide(by * std::numeric_limits<double>::min()));
    }
};

// On which side the line passes of a triangle's edges.
struct Sides8 {
    Wide::Mask all_positive, all_negative, any_positive, any_negative;

    HWY_INLINE Sides8(const Wide3& d, const Wide3& a, const Wide3& b, const Wide3& c)
        : Sides8(d, Cross(c, b)) {
        for (const Sides8& edge : {Sides8(d, Cross(a, c)), Sides8(d, Cross(b, a))}) {
            all_positive = all_positive & edge.all_positive;
            all_negative = all_negative & edge.all_negative;
            any_positive = any_positive | edge.any_positive;
            any_negative = any_negative | edge.any_negative;
        }
    }
    HWY_INLINE Sides8(const Wide3& d, const Cross& edge) {
        const Wide value = edge.dot(d);
        const Wide error = edge.error(d, 1);
        all_positive = any_positive = value > error;
        all_negative = any_negative = value < -error;
    }
};

void find_triangle_roots(PairRoots& roots, std::size_t count) {
    constexpr double kShare = 0.4375 * root_tolerance();
    roots.found = roots.hit = roots.missed = 0;
    for (std::size_t i = 0; i < count; i += kBatch) {
        const Wide3 a = Wide3::load(roots.a, i);
        const Wide3 b = Wide3::load(roots.b, i);
        const Wide3 c = Wide3::load(roots.c, i);
        const Wide3 o = Wide3::load(roots.origin, i);
        const Wide3 d = Wide3::load(roots.direction, i);
        const Cross normal(b - a, c - a);
        const Wide3 toward = a - o;
        const Wide height = normal.dot(toward);
        const Wide slope = normal.dot(d);
        const Wide t = height / slope;
        const Wide::Mask sure = (abs(height) > normal.error(toward, 1 / kShare)) &
                                (abs(slope) > normal.error(d, 1 / kShare));
        const Wide::Mask known =
            sure & (t > Wide(detail::kSmallestRoot)) & (t < Wide(detail::kLargestRoot));
        t.store(roots.t + i);
        roots.found |= known.bits() << i;
        if (roots.only_roots) continue;
        const Sides8 sides(d, toward, b - o, c - o);
        // The edge functions add up to -n.d: of a front all are positive.
        const Wide::Mask front = Wide::Mask::from_bits(roots.front_only >> i & 0xff);
        const Wide::Mask inside = sides.all_positive | without(sides.all_negative, front);
        const Wide::Mask outside = sides.any_negative & (sides.any_positive | front);
        roots.hit |= (known & inside).bits() << i;
        roots.missed |= (outside | (sure & (t < Wide(0.0)))).bits() << i;
    }
}

// rounded_quadratic() and rounded_hit() of spheres that are hit, with the same bounds.
void find_sphere_roots(PairRoots& roots, std::size_t count) {
    constexpr double kShare = 0.4375 * root_tolerance();
    static_assert(gamma(6) <= kShare);  // of a
    roots.found = 0;
    for (std::size_t i = 0; i < count; i += kBatch) {
        const Wide3 f = Wide3::load(roots.origin, i) - Wide3::load(roots.a, i);
        const Wide3 d = Wide3::load(roots.direction, i);
        const Wide r = Wide::load(roots.b[0] + i);
        const Wide a = dot(d, d);
        const Wide length = sqrt(a);
        const Wide b = dot(f, d);
        const Wide along = b * (Wide(1.0) / a);
        const Wide3 l = f - d * along;
        const Wide ff = dot(f, f);
        const Wide rr = r * r;
        const Wide ll = dot(l, l);
        const Wide squares = ff + rr;
        const Wide f_norm = sqrt(ff);
        const Wide c = ff - rr;
        const Wide depth = rr - ll;
        const Wide b_error = f_norm * length * Wide(gamma(7));
        const Wide c_error = squares * Wide(gamma(8));
        const Wide depth_error = sqrt(ll) * f_norm * Wide(gamma(8)) + (ll + rr) * Wide(gamma(8)) +
                                 ff * Wide(gamma(16) * gamma(32));
        const Wide::Mask in_range = (a > Wide(0x1p-800)) & (a < Wide(0x1p800)) &
                                    (squares > Wide(detail::kSmallestSquare)) &
                                    (squares < Wide(detail::kLargestSquare));
        const Wide::Mask inside = c < -c_error;
        const Wide::Mask enters = (c > c_error) & (b < -b_error) & (depth > depth_error);
        // sqrt(1 + x) differs from 1 by less than 0.54 |x| for |x| < 1/4.
        const Wide part = length * sqrt(depth);
        const Wide relative = depth_error / depth;
        const Wide part_error = part * (relative * Wide(0.5625) + Wide(gamma(6)) + Wide(gamma(4)));
        const Wide sum = abs(b) + part;
        const Wide sum_error = b_error + part_error + sum * Wide(gamma(1));
        const Wide::Mask near = enters | (inside & (b > Wide(0.0)));
        const Wide t = select(near, abs(c) / sum, sum / a);
        const Wide::Mask front = Wide::Mask::from_bits(roots.front_only >> i & 0xff);
        const Wide::Mask known =
            in_range & (enters | without(inside, front)) & (depth > Wide(0.0)) &
            (relative < Wide(0.25)) & (sum_error <= sum * Wide(kShare)) &
            (c_error <= abs(c) * Wide(kShare)) & (t > Wide(detail::kSmallestRoot)) &
            (t < Wide(detail::kLargestRoot));
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
