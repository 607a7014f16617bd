#include "convexity.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "nuvo/math/parallel.h"

namespace nuvo::x3d {

namespace {

/// A corner turns clearly where the sine of its angle is above the first of these, and where moving
/// its points by that share of their coordinates would not undo it.
constexpr double kClearSine = 0x1p-10;
constexpr double kSixDigits = 0x1p-20;

/// True where a polygon is clearly not convex.
bool is_concave(const Polygons& polygons, std::size_t i) {
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
    const Vector3 slant{std::fabs(area.x), std::fabs(area.y), std::fabs(area.z)};
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
bool is_convex_in_plane(const Point3& p, const Point3& q, const Point3& r, const Point3& s) {
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

bool is_convex_quad(const Polygons& polygons, std::uint32_t begin, int plane) {
    const std::uint32_t* corner = polygons.corners.data() + begin;
    const Point3* const points = polygons.points.data();
    const Point3 &p = points[corner[0]], &q = points[corner[1]];
    const Point3 &r = points[corner[2]], &s = points[corner[3]];
    return plane == 0   ? is_convex_in_plane<0, 1>(p, q, r, s)
           : plane == 1 ? is_convex_in_plane<1, 2>(p, q, r, s)
                        : is_convex_in_plane<2, 0>(p, q, r, s);
}

}  // namespace

std::size_t count_concave(const Polygons& polygons, int threads) {
    std::atomic<std::size_t> concave = 0;
    for_each_part(threads, polygons.count(), [&](std::size_t begin, std::size_t end) {
        int plane = 0;  // in which the quadrilateral before was convex
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t first = polygons.ends[i];
            const std::uint32_t count = polygons.ends[i + 1] - first;
            if (count < 4 || (count == 4 && is_convex_quad(polygons, first, plane))) continue;
            bool convex = false;
            for (int turn = 0; count == 4 && turn < 2 && !convex; ++turn)
                convex = is_convex_quad(polygons, first, plane = (plane + 1) % 3);
            if (!convex && is_concave(polygons, i)) ++concave;
        }
    });
    return concave;
}

}  // namespace nuvo::x3d
