#include "convexity.h"

#include <algorithm>
#include <cmath>

namespace nuvo::x3d {

namespace {

/// A corner turns clearly where the sine of its angle is above the first of these, and where moving
/// its points by that share of their coordinates would not undo it.
constexpr double kClearSine = 0x1p-10;
constexpr double kSixDigits = 0x1p-20;

/// As is_concave(), without any plane.
bool is_clearly_concave(const Polygons& polygons, std::size_t i) {
    const std::uint32_t begin = polygons.ends[i];
    const std::uint32_t count = polygons.ends[i + 1] - begin;
    const auto point = [&](std::uint32_t c) -> const Point3& {
        return polygons.points[polygons.corners[begin + c % count]];
    };
    double size = 0, place = 0;
    for (std::uint32_t c = 0; c < count; ++c) {
        size = std::fmax(size, max_norm(point(c) - point(0)));
        place = std::fmax(place, max_norm(point(c)));
    }
    if (!(size > 0 && std::isfinite(size))) return false;
    const double blur = 2 * kSixDigits * (place / size);
    const Vector3 area = area_vector(polygons, i);
    const Vector3 normal = normalized(area);
    const Vector3 slant = magnitude(area);
    // An axis across the normal: along it, too, a convex polygon goes up once and down once.
    const int axis = slant.x > slant.y ? (slant.x > slant.z ? 1 : 0) : (slant.y > slant.z ? 2 : 0);
    double turns = 0;
    int first = 0, last = 0, reversals = 0;
    Vector3 before = (point(0) - point(count - 1)) / size;
    for (std::uint32_t c = 0; c < count; ++c) {
        const Vector3 edge = (point(c + 1) - point(c)) / size;
        const Vector3 turn = cross(before, edge);
        const double doubt =
            kClearSine * length(before) * length(edge) + blur * (length(before) + length(edge));
        if (dot(turn, normal) < -doubt) return true;
        if (length(turn) > doubt) turns += length(turn);
        if (std::fabs(edge[axis]) > kClearSine * length(edge) + blur) {
            const int sign = edge[axis] > 0 ? 1 : -1;
            if (last != 0 && sign != last) ++reversals;
            if (first == 0) first = sign;
            last = sign;
        }
        before = edge;
    }
    // A bow whose halves have one size has no area.
    return reversals + (first != last ? 1 : 0) > 2 || length(area) < kClearSine * turns;
}

/// True where a quadrilateral is surely convex in one coordinate plane, which it is not nearly
/// across: all its corners turn to one side.
template <int X, int Y>
bool is_convex_quad(const Point3* points, const std::uint32_t* corners) {
    const Point3 &p = points[corners[0]], &q = points[corners[1]];
    const Point3 &r = points[corners[2]], &s = points[corners[3]];
    const double ax = q[X] - p[X], ay = q[Y] - p[Y];
    const double bx = r[X] - p[X], by = r[Y] - p[Y];
    const double cx = s[X] - p[X], cy = s[Y] - p[Y];
    const double at_q = ax * by - ay * bx;
    const double at_s = bx * cy - by * cx;
    const double at_p = ax * cy - ay * cx;
    const double area = at_q + at_s;
    const double at_r = area - at_p;
    const double diagonals =
        (std::fabs(bx) + std::fabs(by)) * (std::fabs(cx - ax) + std::fabs(cy - ay));
    const double least = std::min(std::min(at_p, at_q), std::min(at_r, at_s));
    const double most = std::max(std::max(at_p, at_q), std::max(at_r, at_s));
    return std::fabs(area) > kClearSine * diagonals && (least > 0 || most < 0);
}

/// The same of a polygon of more corners, which also goes round once: along X up and down once.
template <int X, int Y>
bool is_convex(const Point3* points, const std::uint32_t* corners, std::uint32_t count) {
    const Point3* last = &points[corners[count - 1]];
    double before_x = (*last)[X] - points[corners[count - 2]][X];
    double before_y = (*last)[Y] - points[corners[count - 2]][Y];
    std::uint32_t left = 0, right = 0, reversals = 0;
    for (std::uint32_t c = 0; c < count; ++c) {
        const Point3* const point = &points[corners[c]];
        const double x = (*point)[X] - (*last)[X], y = (*point)[Y] - (*last)[Y];
        const double turn = before_x * y - before_y * x;
        const double doubt = kClearSine * (std::fabs(before_x) + std::fabs(before_y)) *
                             (std::fabs(x) + std::fabs(y));
        left += turn > doubt;
        right += turn < -doubt;
        reversals += (x > 0) != (before_x > 0);
        before_x = x;
        before_y = y;
        last = point;
    }
    return reversals == 2 && (left == count || right == count);
}

bool is_convex(const Polygons& polygons, std::uint32_t begin, std::uint32_t count, int plane) {
    const Point3* const points = polygons.points.data();
    const std::uint32_t* const corners = polygons.corners.data() + begin;
    if (count == 4)
        return plane == 0   ? is_convex_quad<0, 1>(points, corners)
               : plane == 1 ? is_convex_quad<1, 2>(points, corners)
                            : is_convex_quad<2, 0>(points, corners);
    return plane == 0   ? is_convex<0, 1>(points, corners, count)
           : plane == 1 ? is_convex<1, 2>(points, corners, count)
                        : is_convex<2, 0>(points, corners, count);
}

}  // namespace

bool is_concave(const Polygons& polygons, std::size_t i, int& plane) {
    const std::uint32_t begin = polygons.ends[i];
    const std::uint32_t count = polygons.ends[i + 1] - begin;
    if (count < 4 || is_convex(polygons, begin, count, plane)) return false;
    for (int other = 0; other < 2; ++other)
        if (is_convex(polygons, begin, count, plane = (plane + 1) % 3)) return false;
    return is_clearly_concave(polygons, i);
}

}  // namespace nuvo::x3d
