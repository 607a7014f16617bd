#include "nuvo/octree/cost.h"

namespace nuvo {

double sah(const SahTotals& totals, double root_area, const SahCosts& costs) {
    return (costs.interior * totals.interior_area + costs.leaf * totals.leaf_area +
            costs.object * totals.leaf_area_objects) /
           root_area;
}

SahCosts ThesisCosts::operator()(std::size_t leaves) const {
    const auto s = static_cast<float>(shapes);
    const std::size_t share = objects / leaves;  // a whole number, as published
    return {static_cast<float>(leaves * leaves), static_cast<float>(share),
            static_cast<float>(lights) * s * s};
}

float ThesisCosts::of_tree(const SahTotals& totals, double root_area) const {
    const SahCosts costs = (*this)(totals.leaves);
    if (totals.leaves == 1)
        return static_cast<float>(costs.leaf) +
               static_cast<float>(costs.object) * static_cast<float>(objects);
    return static_cast<float>(sah(totals, root_area, costs));
}

}  // namespace nuvo
