#pragma once

#include <bit>
#include <vector>

#include "fast/scene/fast_scene.h"
#include "nuvo/math/error_bounds.h"
#include "nuvo/math/four.h"

// What the hierarchy of single rays is built of, in the local frame.

namespace nuvo {

/// The last lanes hold anything.
struct FourBox {
    Four low = splat(kFloatInfinity);
    Four high = splat(-kFloatInfinity);

    void extend(const FourBox& box) {
        low = least(low, box.low);
        high = most(high, box.high);
    }
    float half_area() const {
        const Four w = high - low;
        return w[0] * w[1] + w[1] * w[2] + w[2] * w[0];
    }
    float volume() const {
        const Four w = high - low;
        return w[0] * w[1] * w[2];
    }
};

/// A primitive, or a part of a large triangle.
struct RayItem {
    FourBox box;  ///< from outside; the last lanes hold slot and width

    RayItem(const Bounds3T<float>& bounds, Slot slot, float width)
        : box{{bounds.min.x, bounds.min.y, bounds.min.z, std::bit_cast<float>(slot)},
              {bounds.max.x, bounds.max.y, bounds.max.z, width}} {}
    Slot slot() const { return std::bit_cast<Slot>(static_cast<float>(box.low[3])); }
    /// The longest side of the box of all of the triangle; infinite for others.
    float width() const { return box.high[3]; }
    /// Twice the middle of the box.
    Four middle() const { return box.low + box.high; }
};

/// Each primitive once; or, of a triangle that is large against the voxels of the scene's octree
/// and lies across them, a part for each: together all of it. So what crosses does not share boxes.
std::vector<RayItem> ray_items(const FastScene& scene);

/// The largest float that is surely not above a coordinate of the local frame.
float float_below(double x);

Triangle local_triangle(const FastScene& scene, Slot slot);

}  // namespace nuvo
