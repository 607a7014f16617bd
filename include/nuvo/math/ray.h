#pragma once

#include "nuvo/math/vec.h"

namespace nuvo {

/// The points origin + t * direction, t > 0. [eq. 1] The direction need not have unit length;
/// t is measured in units of it.
template <typename T>
struct RayT {
    Vec3<T> origin;
    Vec3<T> direction;

    constexpr Vec3<T> at(T t) const { return origin + direction * t; }
};

using Ray = RayT<double>;

}  // namespace nuvo
