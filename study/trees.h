#pragma once

#include "methods.h"
#include "nuvo/octree/build.h"
#include "nuvo/render/render.h"

/// Octrees by any method, over a scene.
namespace nuvo::study {

/// What else decides a tree beside the method.
struct TreeOptions {
    LeafContent leaves = LeafContent::kPrimitives;
    /// As the program builds: the method's planes go to the items' box where that is small, and the
    /// centre is tried where they save little. Otherwise the method alone decides, and where it
    /// gives no point the centre does.
    bool in_program = false;
    double step = CalibratedCosts{}.step;  ///< in units of one primitive test
    bool thesis_costs = false;             ///< and the published order; items stay calibrated else
};

/// The prices of a leaf item in place of a primitive: whole shapes cost as many tests as they hold
/// primitives, on average.
CalibratedCosts costs_of(const Primitives& primitives, double step);

/// What keeps items out of voxels that their boxes touch; empty for whole shapes.
OverlapTest overlap_test(const Scene& scene, const Primitives& primitives, LeafContent leaves);
/// How far items are inflated: the walk's error, and that of coordinates as large as `beside`.
double margin_of(const Primitives& primitives, const Bounds3& beside = {});

/// The tree of `method`. A search adds its evaluations to `*evaluations`, which may be null.
Octree build_tree(const Scene& scene, const Primitives& primitives, const Method& method,
                  const TreeOptions& options, Evaluations* evaluations = nullptr);

/// The tree without those cuts that do not pay once all below them is cut. [bottom-up]
Octree pruned(const Octree& octree, const CalibratedCosts& costs);

}  // namespace nuvo::study
