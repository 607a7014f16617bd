#pragma once

#include <functional>
#include <limits>
#include <span>
#include <variant>

#include "nuvo/math/progress.h"
#include "nuvo/octree/cost.h"
#include "nuvo/octree/midpoint.h"
#include "nuvo/octree/octree.h"

namespace nuvo {

/// The assignment's stop rule: a voxel is cut until it holds at most `count` items. [COMP1011]
struct MaxObjects {
    std::size_t count = 1;
};
/// Whether item `id`, whose box overlaps the closed `box`, really has surface in it.
using OverlapTest = std::function<bool(ItemId id, const Bounds3& box)>;

struct BuildOptions {
    MidpointStrategy midpoint = spatial_midpoint;
    MidpointStrategy fallback;  ///< tried, too, where cuts save little; not under ThesisCosts
    std::variant<CalibratedCosts, ThesisCosts, MaxObjects> worth = CalibratedCosts{};
    OverlapTest overlaps;  ///< empty: the boxes decide
    double margin = 0;     ///< items are listed where they come this near; scene units
    /// An item whose box does no more than touch a cut's plane is not listed beyond it, and one
    /// that lies in the plane nowhere: the published placement, for walks that are pushed past
    /// planes.
    bool strict_placement = false;
    int max_depth = kMaxLabelDigits + 1;  ///< levels, 1..20
    /// No voxel is cut once the leaves hold this many references to items: a bound on time and
    /// memory where items lie so close that cuts hardly part them. What it buys under constant
    /// prices grows with it: a larger budget goes on where a smaller one ends.
    std::size_t max_references = kNoLimit;
    /// In references, of `max_references`: many a tree is done with fewer.
    Progress* progress = nullptr;

    static constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();
};

/// Cuts the box of all `boxes` into an octree. Under ThesisCosts, which depend on the leaves so
/// far, depth first in label order; a split under which the whole tree's cost does not fall is
/// taken back. [thesis 4.4.2, 5.4.1] Under constant prices the cut first that saves most for each
/// reference added, and, with a margin, on those axes only on which cutting pays. An axis on which
/// a voxel is not cut, for that or because its halves would be thinner than a few ulp of their
/// coordinates, gives upper octants without width, which hold nothing. Nodes and items stand depth
/// first in any case.
Octree build_octree(std::span<const Bounds3> boxes, const BuildOptions& options = {});

/// For the builders: tells `options.progress` of the tree of one leaf that lists all items.
inline void begin_progress(const BuildOptions& options, std::size_t items) {
    const bool endless = options.max_references == BuildOptions::kNoLimit;
    begin(options.progress, "references", endless ? 0 : options.max_references);
    add(options.progress, items);
}

/// Sums of a finished tree computed afresh, for comparison with the builder's running ones.
SahTotals sah_totals(const Octree& octree);

}  // namespace nuvo
