#include <cmath>

#include "nuvo/geometry/predicates.h"

// What holds of two triangles for all rays from one point, or to one light. [numerics: crowds]
namespace nuvo {
namespace {

/// The least of the sides of the corners of `t`, seen from a point on `side` of the plane: 1 if all
/// lie strictly on its side, 0 if none lies beyond the plane.
int least_side(const Triangle& plane, int side, const Triangle& t, StageCounts& counts) {
    int least = 1;
    for (const Point3& corner : {t.a, t.b, t.c}) {
        const int sign = side * counts.sides.side(plane, corner, counts.exact);
        if (sign < 0) return -1;
        if (sign < least) least = sign;
    }
    return least;
}

int side_of_light(const Triangle& plane, const LightPlace& light, StageCounts& counts) {
    return light.endless ? counts.sides.side_along(plane, light.at, counts.exact)
                         : counts.sides.side(plane, light.at, counts.exact);
}

/// So that the largest component is 1.
Vector3 scaled(const Vector3& v) { return v / max_norm(v); }
Vector3 scaled_normal(const Triangle& t) { return cross(scaled(t.b - t.a), scaled(t.c - t.a)); }

/// The point moved to the other side of the plane of `t` by a few times its error; none: not found.
std::optional<WayStart> across_plane(const WayStart& start, const Triangle& t, int side,
                                     StageCounts& counts) {
    constexpr int kTries = 8;
    const Vector3 n = scaled_normal(t);
    if (n == Vector3{} || !(start.error > 0)) return std::nullopt;
    const Vector3 unit = scaled(n) * side;  // n.(a - p) falls along n
    for (double step = 4 * start.error; step < std::ldexp(start.error, 2 + kTries); step *= 2) {
        const WayStart across{start.point + unit * step, start.error + 2 * step};
        if (counts.sides.side(t, across.point, counts.exact) == -side) return across;
    }
    return std::nullopt;
}

}  // namespace

bool coplanar(const Triangle& a, const Triangle& b, StageCounts& counts) {
    const auto in_plane = [&](const Point3& corner) {
        return counts.sides.side(a, corner, counts.exact) == 0;
    };
    return in_plane(b.a) && in_plane(b.b) && in_plane(b.c);
}

bool hides(const Triangle& front, const Point3& eye, const Triangle& other, bool wins_ties,
           StageCounts& counts) {
    const int needed = wins_ties ? 0 : 1;
    // `other` lies beyond the plane of `front`, or `front` before that of `other`.
    const int before_front = counts.sides.side(front, eye, counts.exact);
    if (before_front != 0 && least_side(front, -before_front, other, counts) >= needed) return true;
    const int before_other = counts.sides.side(other, eye, counts.exact);
    return before_other == 0 || least_side(other, before_other, front, counts) >= needed;
}

bool leaves_in_light(const Triangle& other, const Triangle& lit, const LightPlace& light,
                     StageCounts& counts) {
    const int side = side_of_light(other, light, counts);
    return side == 0 || least_side(other, side, lit, counts) >= 0;
}

bool stays_behind(const Triangle& other, const Triangle& lit, const LightPlace& light,
                  StageCounts& counts) {
    const int side = side_of_light(lit, light, counts);
    return side != 0 && least_side(lit, -side, other, counts) >= 0;
}

bool grazes(const Triangle& lit, const LightPlace& light, double distance) {
    constexpr double kMillionth = 0x1p-20;
    const Vector3 way = light.endless ? light.at : light.at - lit.a;
    return std::fabs(dot(scaled_normal(lit), way)) <= kMillionth * distance;
}

WayStarts way_starts(const WayStart& rounded, const Triangle& lit, const LightPlace& light,
                     StageCounts& counts) {
    WayStarts starts{rounded, std::nullopt};
    if (!grazes(lit, light, max_norm(light.endless ? light.at : light.at - rounded.point)))
        return starts;
    const int side = counts.sides.side(lit, rounded.point, counts.exact);
    if (side == 0) return starts;  // exactly in the plane
    const int of_light = side_of_light(lit, light, counts);
    if (of_light == side) return starts;
    const std::optional<WayStart> across = across_plane(rounded, lit, side, counts);
    if (!across) return starts;
    if (of_light != 0)
        starts.first = *across;
    else
        starts.second = across;
    return starts;
}

}  // namespace nuvo
