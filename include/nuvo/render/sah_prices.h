#pragma once

#include "nuvo/octree/cost.h"
#include "nuvo/render/render.h"

namespace nuvo {

/// The prices by which build_tree judges cuts where there are so many leaves; where it counts items
/// instead, those of CalibratedCosts. [eq. 10]
SahCosts sah_prices(const Scene& scene, const Primitives& primitives, const Profile& profile,
                    std::size_t leaves);

}  // namespace nuvo
