#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compact_split.h"

namespace nuvo {

/// What a voxel may still take: a share of the whole tree's limits, in proportion to its items, so
/// that no part of the scene takes what another needs.
struct Allowance {
    double references = 0;
    double nodes = 0;  ///< below the voxel's own

    bool permits(const Split& split) const {
        return static_cast<double>(split.references()) <= references && nodes >= 8;
    }
    /// The share of an octant of what is left beside the octants' own nodes.
    Allowance share(const Split& split, unsigned octant) const {
        const double part =
            static_cast<double>(split.counts[octant]) / static_cast<double>(split.references());
        return {references * part, (nodes - split.octants()) * part};
    }
};

/// A voxel still to be built: its box, its level (the root's is 1) and its allowance.
struct Place {
    Bounds3T<float> voxel;
    int level = 1;
    Allowance allowance;

    Place octant(const Split& split, unsigned o) const {
        return {octant_box(split.voxel, o), level + 1, allowance.share(split, o)};
    }
};

/// A finished subtree without its root: nodes and runs, with places that count from 0.
struct Subtree {
    CompactNode root;
    double cost = 0;  ///< as Prices gives it
    std::vector<CompactNode> nodes;
    std::vector<std::uint32_t> items;
};

/// Builds subtrees one after another. One for each thread: it keeps its buffers.
class SubtreeBuilder {
  public:
    SubtreeBuilder(BoxSpan boxes, const CompactBuildOptions& options)
        : boxes_(boxes),
          rule_(options.rule),
          prices_(options.costs),
          marker_(boxes, options.overlaps) {}

    Subtree build(const Place& place, ItemSpan items);

  private:
    struct Built {
        CompactNode node;
        double cost = 0;
    };
    // The items of a voxel: places in stack_.
    struct Run {
        std::size_t begin;
        std::size_t count;
    };
    Built node(const Place& place, Run run);
    Built leaf(const Place& place, Run run);
    Built interior(const Place& place, const Split& split, Run run);
    std::optional<Split> try_split(const Place& place, ItemSpan items);
    ItemSpan items(Run run) const { return ItemSpan(stack_).subspan(run.begin, run.count); }

    BoxSpan boxes_;
    CutRule rule_;
    Prices prices_;
    OctantMarker marker_;
    std::vector<std::uint8_t> masks_;   // of the voxel that was split last
    std::vector<std::uint32_t> stack_;  // items of the voxels between the root and this one
    std::size_t top_ = 0;
    Subtree out_;
};

}  // namespace nuvo
