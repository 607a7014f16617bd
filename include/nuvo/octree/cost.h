#pragma once

#include <cstddef>

namespace nuvo {

/// The three prices of the surface area heuristic. [thesis 2.2.3]
struct SahCosts {
    double interior = 0;  ///< C_i: traversing an interior node
    double leaf = 0;      ///< C_l: traversing a leaf
    double object = 0;    ///< C_0: testing an object in a leaf
};

/// The sums of eq. 10 over a whole tree; areas in square scene units.
struct SahTotals {
    double interior_area = 0;
    double leaf_area = 0;
    double leaf_area_objects = 0;  ///< leaf area times the leaf's number of objects
    std::size_t leaves = 0;
};

/// The tree's expected cost per ray that enters the root, whose area is `root_area`. [eq. 10]
double sah(const SahTotals& totals, double root_area, const SahCosts& costs);

/// Prices of thesis 5.4.1, which depend on the number of leaves so far.
struct ThesisCosts {
    double shapes = 0;  ///< numShapes
    double lights = 0;  ///< numLights

    /// V^2, S / V and L S^2.
    SahCosts operator()(std::size_t leaves) const;
};

/// Constant prices in units of one primitive test: a node step costs `step`.
struct CalibratedCosts {
    double step = 6;

    SahCosts costs() const { return {step, step, 1}; }
};

}  // namespace nuvo
