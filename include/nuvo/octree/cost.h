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

/// What the published program counts in 5.4.1's numShapes: 1, and for each shape so much. The 1.5
/// is a result of the parameter search of 4.8.
inline constexpr double kThesisShapesBase = 1;
inline constexpr double kThesisShapesPerSphere = 1;
inline constexpr double kThesisShapesPerTriangle = 1.5;

/// Prices of thesis 5.4.1, which depend on the number of leaves so far, in float as published.
struct ThesisCosts {
    double shapes = 0;        ///< numShapes
    double lights = 0;        ///< numLights
    std::size_t objects = 0;  ///< in the root

    /// With V leaves: V^2; objects / V, a whole number; L S^2.
    SahCosts operator()(std::size_t leaves) const;
    /// What cuts are judged by: the whole tree's cost, rounded to float. A tree of one leaf costs
    /// that leaf and its objects.
    float of_tree(const SahTotals& totals, double root_area) const;
};

/// Constant prices in units of one test of a leaf item: a node step costs `step`, as measured where
/// items are single primitives.
struct CalibratedCosts {
    double step = 6;

    SahCosts costs() const { return {step, step, 1}; }
};

}  // namespace nuvo
