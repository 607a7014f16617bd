// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_AFFINE_LANES_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_AFFINE_LANES_H_
#undef NUVO_RENDER_FAST_AFFINE_LANES_H_
#else
#define NUVO_RENDER_FAST_AFFINE_LANES_H_
#endif

#include <cmath>

#include "fast/simd/lanes.h"
#include "nuvo/math/error_bounds.h"
#include "nuvo/math/vec.h"

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// Eight boxes of the local frame.
struct MiddlesAndHalves {
    OctantFloats middle[3];
    OctantFloats half[3];
    OctantFloats distance[3];  ///< |middle|
};

/// f . (p - origin) + constant in the local frame. [numerics: voxels seen by a macro tile]
class Affine {
  public:
    Affine() = default;
    /// For coordinates up to `reach`; `size` bounds the terms whose sums are f's components.
    Affine(const Vector3& f, const Vector3& size, const Point3& origin, double reach,
           double constant = 0) {
        double of_constant = std::fabs(constant);
        double most = of_constant;
        for (int axis = 0; axis < 3; ++axis) {
            const double term = std::fabs(size[axis]);
            constant -= f[axis] * origin[axis];
            of_constant += term * std::fabs(origin[axis]);
            most += term * (reach + std::fabs(origin[axis]));
            f_[axis] = static_cast<float>(f[axis]);
            error_[axis] = rounded_up(roundings(kRoundings) * term);
            spread_[axis] = std::fabs(f_[axis]) + error_[axis];
        }
        constant_ = static_cast<float>(constant);
        constant_error_ = rounded_up(roundings(kRoundings) * of_constant + kFloatUnderflow);
        usable_ = most < kLargest;
    }
    /// Whether no sum is beyond floats.
    bool usable() const { return usable_; }
    template <typename Numbers>
    HWY_INLINE Numbers at(const Numbers (&p)[3]) const {
        return mul_add(
            p[0], Numbers(f_[0]),
            mul_add(p[1], Numbers(f_[1]), mul_add(p[2], Numbers(f_[2]), Numbers(constant_))));
    }
    /// Bounds what at() is off by at points of such |coordinates|, rounded to nearest.
    template <typename Numbers>
    HWY_INLINE Numbers error(const Numbers (&size)[3]) const {
        return mul_add(size[0], Numbers(error_[0]),
                       mul_add(size[1], Numbers(error_[1]),
                               mul_add(size[2], Numbers(error_[2]), Numbers(constant_error_))));
    }
    /// How far it may be off at the middles and differ from them in the boxes.
    HWY_INLINE OctantFloats spread(const MiddlesAndHalves& boxes) const {
        OctantFloats sum = error(boxes.distance);
        for (int axis = 0; axis < 3; ++axis)
            sum = mul_add(boxes.half[axis], OctantFloats(spread_[axis]), sum);
        return sum;
    }

  private:
    // Fifteen, docs/numerics.md; one for what double arithmetic rounds, one for the bound's own.
    static constexpr double kRoundings = 17;
    static constexpr double kLargest = 0x1p90;

    float f_[3];
    float error_[3];
    float spread_[3];
    float constant_;
    float constant_error_;
    bool usable_;
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_AFFINE_LANES_H_
