#pragma once

// A light far outside of the scene sees it through one plane, x_k = 0 for the axis k along which it
// stands farthest: the shadow ray through P meets that plane at u = P_u - P_k W_u / W_k, W being
// the vector from P to the light. A light among the items looks through the six faces of a cube
// around it, at u = W_u / W_k.

namespace nuvo {

/// Places on a light's plane or face count from 0 to kLightSteps - 1 on both axes.
inline constexpr int kLightSteps = 1 << 16;

/// Bounds LightMap::point_error, in units of LightMap::point_size.
inline constexpr double kMostPointError = 0x1p-14;

/// Where a light sees the points of the scene. What lies beyond the steps counts as their border.
struct LightMap {
    bool inside = false;         ///< six faces; else one
    int axis = 0;                ///< k of the one face
    float sign = 1;              ///< of W_k
    float low[2] = {};           ///< u and v of step 0
    float steps[2] = {};         ///< per unit of u and v
    float point_size = 0;        ///< points with larger coordinates are not looked up
    float point_error = 0;       ///< points known this well are looked up at one place
    float stretch = 0;           ///< of u and v for an error of 1; inside: of W_k = 1
    float nearest = 0;           ///< inside: points with a lesser W_k are not looked up
    float most_moved = 0x1p60F;  ///< nor are points whose u or v may be off by more

    int faces() const { return inside ? 6 : 1; }
};

}  // namespace nuvo
