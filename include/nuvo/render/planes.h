#pragma once

#include <cstdint>
#include <vector>

#include "nuvo/render/render.h"

namespace nuvo {

/// The stage of a test that decided it. The tests in float or double have no other than the first.
enum class Stage : std::uint8_t {
    kCheap,  ///< the first bounds in double
    kWider,  ///< tighter bounds
    kExact,  ///< exact arithmetic
};

/// What each pixel of a picture showed and cost, in arrays by rows from the top.
struct PixelPlanes {
    std::vector<std::uint32_t> tests;     ///< rays against leaf items, its shadow rays' included
    std::vector<std::uint32_t> searches;  ///< for a next voxel
    std::vector<double> t;                ///< of the nearest hit; infinity: the background
    std::vector<std::int32_t> shape;      ///< the Shape's place in the document; -1: the background
    std::vector<std::int32_t> triangle;   ///< in the Shape's own list, 0: sphere; -1: background
    std::vector<Stage> stage;             ///< the last that any test of the pixel needed
    TraceCounts counts;                   ///< of the picture: the sums of `tests` and `searches`
};

/// The planes behind render()'s picture, from one more run of the same walk, which remembers from
/// pixel to pixel what that does; `octree` null: behind render_brute_force()'s.
PixelPlanes record_planes(const Scene& scene, const Primitives& primitives, const Octree* octree,
                          const Profile& profile, Resolution resolution,
                          Progress* progress = nullptr);

}  // namespace nuvo
