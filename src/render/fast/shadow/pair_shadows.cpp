#include "fast/shadow/pair_shadows.h"

#include <cmath>

#include "exact_kernel.h"

namespace nuvo {
namespace {

constexpr double kMuch = 0x1p-20;

// Ways from all points of `lit` run along its plane, which its corners tell well.
bool all_graze(const Triangle& lit, const LightPlace& light) {
    const Vector3 e1 = lit.b - lit.a;
    const Vector3 e2 = lit.c - lit.a;
    const double size = std::fmax(max_norm(e1), max_norm(e2));
    const bool thin = max_norm(cross(e1, e2)) <= kMuch * max_norm(e1) * max_norm(e2);
    const double distance =
        light.endless ? max_norm(light.at) : max_norm(light.at - lit.a) - 2 * size;
    return !thin && grazes(lit, light, distance / 2);
}

// The corner rises from the plane by much more than what rounds a lit point.
bool rises(const Triangle& plane, const Point3& corner) {
    const Vector3 e1 = plane.b - plane.a;
    const Vector3 e2 = plane.c - plane.a;
    const Vector3 way = corner - plane.a;
    const double size = max_norm(e1) * max_norm(e2) * std::fmax(max_norm(way), max_norm(corner));
    return std::fabs(dot(cross(e1, e2), way)) > kMuch * size;
}

}  // namespace

PairShadow PairShadows::find(Slot lit, Slot occluder, std::size_t light) {
    const LightPlace place = place_of(scene_.scene().lights[light]);
    const Triangle plane = scene_.triangle(lit);
    const Triangle other = scene_.triangle(occluder);
    if (leaves_in_light(other, plane, place, counts_) || stays_behind(other, plane, place, counts_))
        return PairShadow::kNone;
    if (!all_graze(plane, place)) return PairShadow::kOpen;
    const auto in_plane = [&](const Point3& corner) {
        return counts_.sides.side(plane, corner, counts_.exact) == 0;
    };
    const bool a = in_plane(other.a);
    const bool b = in_plane(other.b);
    const bool c = in_plane(other.c);
    // It does not stay behind: if its third corner has a side, that is the light's.
    if (a && b && rises(plane, other.c)) return PairShadow::kPastEdgeAB;
    if (a && c && rises(plane, other.b)) return PairShadow::kPastEdgeAC;
    if (b && c && rises(plane, other.a)) return PairShadow::kPastEdgeBC;
    return PairShadow::kOpen;
}

}  // namespace nuvo
