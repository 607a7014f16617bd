#include "nuvo/octree/cost.h"

namespace nuvo {

double sah(const SahTotals& totals, double root_area, const SahCosts& costs) {
    return (costs.interior * totals.interior_area + costs.leaf * totals.leaf_area +
            costs.object * totals.leaf_area_objects) /
           root_area;
}

SahCosts ThesisCosts::operator()(std::size_t leaves) const {
    const double voxels = static_cast<double>(leaves);
    return {voxels * voxels, shapes / voxels, lights * shapes * shapes};
}

}  // namespace nuvo
