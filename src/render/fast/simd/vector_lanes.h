// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_VECTOR_LANES_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_VECTOR_LANES_H_
#undef NUVO_RENDER_FAST_VECTOR_LANES_H_
#else
#define NUVO_RENDER_FAST_VECTOR_LANES_H_
#endif

#include <cstddef>

#include "fast/simd/lanes.h"
#include "nuvo/math/vec.h"

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// N vectors of three numbers, one a lane.
template <typename T, std::size_t N>
struct VectorLanes {
    using Number = Lanes<T, N>;

    Number x, y, z;

    /// The same in all lanes.
    static HWY_INLINE VectorLanes all(const Vec3<T>& v) {
        return {Number(v.x), Number(v.y), Number(v.z)};
    }
    /// From three columns.
    template <std::size_t kColumn>
    static HWY_INLINE VectorLanes load(const T (*columns)[kColumn], std::size_t first = 0) {
        return {Number::load(columns[0] + first), Number::load(columns[1] + first),
                Number::load(columns[2] + first)};
    }
    HWY_INLINE const Number& operator[](int axis) const {
        return axis == 0 ? x : axis == 1 ? y : z;
    }

    friend HWY_INLINE VectorLanes operator+(const VectorLanes& a, const VectorLanes& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend HWY_INLINE VectorLanes operator-(const VectorLanes& a, const VectorLanes& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend HWY_INLINE VectorLanes operator*(const VectorLanes& a, const Number& s) {
        return {a.x * s, a.y * s, a.z * s};
    }
    /// a s + b, fused.
    friend HWY_INLINE VectorLanes mul_add(const VectorLanes& a, const Number& s,
                                          const VectorLanes& b) {
        return {mul_add(a.x, s, b.x), mul_add(a.y, s, b.y), mul_add(a.z, s, b.z)};
    }
    friend HWY_INLINE VectorLanes cross(const VectorLanes& a, const VectorLanes& b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
    friend HWY_INLINE VectorLanes fused_cross(const VectorLanes& a, const VectorLanes& b) {
        return {neg_mul_add(a.z, b.y, a.y * b.z), neg_mul_add(a.x, b.z, a.z * b.x),
                neg_mul_add(a.y, b.x, a.x * b.y)};
    }
    friend HWY_INLINE Number dot(const VectorLanes& a, const VectorLanes& b) {
        return a.x * b.x + a.y * b.y + a.z * b.z;
    }
    friend HWY_INLINE Number fused_dot(const VectorLanes& a, const VectorLanes& b) {
        return mul_add(a.x, b.x, mul_add(a.y, b.y, a.z * b.z));
    }
    friend HWY_INLINE Number norm1(const VectorLanes& a) { return abs(a.x) + abs(a.y) + abs(a.z); }
    friend HWY_INLINE Number max_norm(const VectorLanes& a) {
        return max(abs(a.x), max(abs(a.y), abs(a.z)));
    }
    friend HWY_INLINE VectorLanes select(const typename Number::Mask& mask, const VectorLanes& a,
                                         const VectorLanes& b) {
        return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
    }
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_VECTOR_LANES_H_
