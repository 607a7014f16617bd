#include "fast/scene/ball_map.h"

#include <cmath>

#include "nuvo/math/error_bounds.h"

namespace nuvo {
namespace {

// Flatter ellipsoids go to the exact stage: bounds grow by this, squared.
constexpr double kMostStretch = 0x1p8;
// Of to_ball, in units of its stretch: far below a float's roundoff, also of what it makes short.
constexpr double kMostError = 0x1p-40;
constexpr double kSmallest = 0x1p-300;  // no product below underflows

// The largest sum of a row's magnitudes.
double row_sum(const Matrix3& m) {
    double largest = 0;
    for (const Vector3& row : m.row) largest = std::fmax(largest, norm1(row));
    return largest;
}

}  // namespace

BallMap ball_map(const Ellipsoid& ellipsoid, const LocalFrame& frame) {
    BallMap map{};
    map.center = frame.local(ellipsoid.center);
    Matrix3& m = map.from_unit;
    m = ellipsoid.linear;
    for (Vector3& row : m.row) row = row * ellipsoid.radius * frame.scale;
    const Matrix3 adjugate = m.adjugate();
    const Matrix3 magnitudes = Matrix3{
        {cross_magnitude(m.row[1], m.row[2]), cross_magnitude(m.row[2], m.row[0]),
         cross_magnitude(
             m.row[0], m.row[1])}}.transposed();
    const double determinant = dot(m.row[0], adjugate.column(0));
    const double terms = dot(magnitude(m.row[0]), magnitudes.column(0));
    const double size = row_sum(m) * (1 + gamma(4));
    map.sure = false;
    if (!(std::fabs(determinant) > kSmallest && size < 1 / kSmallest)) return map;
    // m has one rounding of each component: its products of two 4 with their own and the
    // difference's, the determinant's 8.
    const double relative = gamma(8) * terms / std::fabs(determinant) * (1 + gamma(8));
    map.radius = std::exp2(std::ceil(std::log2(size)));
    const double factor = map.radius / determinant;
    for (int i = 0; i < 3; ++i) map.to_ball.row[i] = adjugate.row[i] * factor;
    const double stretch = row_sum(map.to_ball);
    map.error =
        (gamma(8) * row_sum(magnitudes) * std::fabs(factor) + stretch * (2 * relative + gamma(4))) *
        (1 + gamma(16));
    map.stretch = stretch * (1 + gamma(4)) + map.error;
    map.sure =
        relative < kMostError && map.stretch < kMostStretch && map.error < kMostError * map.stretch;
    return map;
}

}  // namespace nuvo
