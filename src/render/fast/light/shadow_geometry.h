#pragma once

#include <cstdint>

// What a triangle hides from a light is a cone cut off by the triangle: the points on the inner
// side of the three planes through the light and an edge, and beyond the triangle's own (shadow
// volumes: Crow 1977, "Shadow algorithms for computer graphics"). All four are affine functions of
// the point, for a light at a place and for one in a direction alike; so a shadow ray against a
// triangle is 12 multiplications and additions and a minimum.

namespace nuvo {

/// Four functions n.P + w of a point P of the local frame, |n|_1 = 1, positive where the triangle
/// hides P from the light. The first three belong to the edges, the last to the triangle's plane.
/// One that double arithmetic cannot place well enough is 0 everywhere: it decides nothing.
struct alignas(64) ShadowPlanes {
    float plane[4][4];  ///< n, w
};

/// Where a light stands towards a quadric; kBlind: it sees no front of it, or the shape casts
/// no shadow.
enum class LightSide : std::uint8_t { kOutside, kInside, kBlind, kUnknown };

}  // namespace nuvo
