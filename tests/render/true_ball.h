#pragma once

#include <cmath>
#include <random>

#include "fast_cases.h"
#include "nuvo/geometry/ellipsoid.h"
#include "real_numbers.h"

namespace nuvo::testing {

/// The exact map of an ellipsoid to its ball.
class TrueBall {
  public:
    TrueBall(const Ellipsoid& ellipsoid, double scale, double radius) {
        RealVector row[3];
        for (int i = 0; i < 3; ++i)
            row[i] = RealVector(ellipsoid.linear.row[i]) * Real(ellipsoid.radius) * Real(scale);
        const RealVector column[3] = {cross(row[1], row[2]), cross(row[2], row[0]),
                                      cross(row[0], row[1])};
        const Real factor = Real(radius) / dot(row[0], column[0]);
        for (int i = 0; i < 3; ++i)
            row_[i] = RealVector(column[0][i], column[1][i], column[2][i]) * factor;
    }
    RealVector operator()(const RealVector& v) const {
        return {dot(row_[0], v), dot(row_[1], v), dot(row_[2], v)};
    }

  private:
    RealVector row_[3];
};

/// Of half axes from `size` down to 2^flattest of it; some mirrored or skewed.
inline Ellipsoid random_ellipsoid(std::mt19937_64& random, const Point3& center, double size,
                                  double flattest) {
    Ellipsoid e{center, {}, size};
    const Vector3 axis = uniform_point(random, 1) - Point3{};
    const Matrix3 turn = rotation(axis, uniform(random, 0, 6));
    Matrix3 stretch;
    for (int i = 0; i < 3; ++i)
        stretch.row[i] = stretch.row[i] * std::exp2(uniform(random, flattest, 0));
    if (random() % 8 == 0) stretch.row[0] = -stretch.row[0];
    e.linear = turn * stretch;
    if (random() % 4 == 0) e.linear.row[random() % 3].x *= 1.5;  // and skewed
    return e;
}

inline Real largest(const RealVector& v) {
    using std::max;
    return max(max(abs(v.x), abs(v.y)), abs(v.z));
}

}  // namespace nuvo::testing
