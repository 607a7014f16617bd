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

}  // namespace

bool hides(const Triangle& front, const Point3& eye, const Triangle& other, bool wins_ties,
           StageCounts& counts) {
    const int needed = wins_ties ? 0 : 1;
    // `other` lies beyond the plane of `front`, or `front` before that of `other`.
    const int before_front = counts.sides.side(front, eye, counts.exact);
    if (before_front != 0 && least_side(front, -before_front, other, counts) >= needed) return true;
    const int before_other = counts.sides.side(other, eye, counts.exact);
    return before_other == 0 || least_side(other, before_other, front, counts) >= needed;
}

bool leaves_in_light(const Triangle& other, const Triangle& lit, const Vector3& light, bool endless,
                     StageCounts& counts) {
    const int side = endless ? counts.sides.side_along(other, light, counts.exact)
                             : counts.sides.side(other, light, counts.exact);
    return side == 0 || least_side(other, side, lit, counts) >= 0;
}

}  // namespace nuvo
