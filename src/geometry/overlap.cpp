#include "nuvo/geometry/overlap.h"

#include <cmath>

#include "nuvo/math/error_bounds.h"

namespace nuvo {
namespace {

Vector3 absolute(const Vector3& v) { return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}; }

// True when the projections of the corners v onto `axis` all lie beyond the box's, by more than
// `error`, the rounding of one projection.
bool separated(const Vector3& axis, const Vector3 (&v)[3], const Vector3& half, double error) {
    const double p0 = dot(axis, v[0]);
    const double p1 = dot(axis, v[1]);
    const double p2 = dot(axis, v[2]);
    const double reach = dot(half, absolute(axis)) + error;
    return (p0 > reach && p1 > reach && p2 > reach) || (p0 < -reach && p1 < -reach && p2 < -reach);
}

}  // namespace

bool overlaps(const Triangle& triangle, const Bounds3& box) {
    if (!triangle.bounds().overlaps(box)) return false;
    const Point3 center = box.center();
    // Rounding of the centre, of the half widths and of the corners' differences.
    const double size = std::fmax(max_norm(box.min), max_norm(box.max));
    const double slack = gamma(4) * size + 4 * kUnderflow;
    const Vector3 half = box.widths() * 0.5 + Vector3{slack, slack, slack};
    const Vector3 v[3] = {triangle.a - center, triangle.b - center, triangle.c - center};
    const Vector3 edge[3] = {triangle.b - triangle.a, triangle.c - triangle.b,
                             triangle.a - triangle.c};
    const double reach = max_norm(v[0]) + max_norm(v[1]) + max_norm(v[2]) + max_norm(half);

    // Below the normal range a product loses up to kUnderflow more: six that are multiplied once
    // more, and some of sums. The bounds are infinite where a partial sum could overflow.
    constexpr double kHeadroom = 16;
    const double underflow = 16 * kUnderflow * (reach + 1);
    const double room = kHeadroom * reach;
    // Plane: three products of three factors, each factor rounded.
    const double edges = max_norm(edge[0]) * max_norm(edge[1]);
    if (separated(cross(edge[0], edge[1]), v, half,
                  gamma(40) / kHeadroom * (edges * room) + underflow))
        return false;
    for (const Vector3& e : edge) {
        const double error = gamma(16) / kHeadroom * (max_norm(e) * room) + underflow;
        if (separated({0, -e.z, e.y}, v, half, error) ||
            separated({e.z, 0, -e.x}, v, half, error) || separated({-e.y, e.x, 0}, v, half, error))
            return false;
    }
    return true;
}

bool overlaps(const Sphere& sphere, const Bounds3& box) {
    double nearest = 0;  // squared distances from the centre to the box
    double farthest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double below = box.min[axis] - sphere.center[axis];
        const double above = sphere.center[axis] - box.max[axis];
        const double outside = std::fmax(0.0, std::fmax(below, above));
        const double across = std::fmax(std::fabs(below), std::fabs(above));
        nearest += outside * outside;
        farthest += across * across;
    }
    const double squared = sphere.radius * sphere.radius;
    // Eight products at most lose something to underflow.
    constexpr double kLost = 8 * kUnderflow;
    return nearest <= squared * (1 + gamma(8)) + kLost &&
           farthest + kLost >= squared * (1 - gamma(8));
}

}  // namespace nuvo
