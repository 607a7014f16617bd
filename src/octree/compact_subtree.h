#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compact_split.h"

namespace nuvo {

/// What a voxel may still take: a share of the whole tree's limits.
struct Allowance {
    double references = 0;
    double nodes = 0;

    /// The share of an octant with `count` of `references` items, of what is left after the
    /// octants' own nodes.
    Allowance share(std::size_t count, std::size_t all, unsigned octants) const {
        const double part = static_cast<double>(count) / static_cast<double>(all);
        return {references * part, (nodes - octants) * part};
    }
    bool permits(const Split& split) const {
        return static_cast<double>(split.references) <= references && nodes > 8;
    }
};

/// A voxel still to be built: its box, its level (the root's is 1) and its allowance.
struct Place {
    Bounds3T<float> voxel;
    int level = 1;
    Allowance allowance;
};

/// A finished subtree without its root: nodes and runs, with places that count from 0.
struct Subtree {
    CompactNode root;
    double cost = 0;  ///< expected cost times half the root's surface
    std::vector<CompactNode> nodes;
    std::vector<std::uint32_t> items;
};

/// Builds subtrees one after another. One for each thread: it keeps its buffers.
class SubtreeBuilder {
  public:
    SubtreeBuilder(BoxSpan boxes, const CompactBuildOptions& options) : splitter_(boxes, options) {}

    /// The subtree of these items.
    Subtree build(const Place& place, ItemSpan items);

  private:
    struct Built {
        CompactNode node;
        double cost;
    };
    // The items stand in stack_ from `begin` on.
    Built node(const Place& place, std::size_t begin, std::size_t count);
    Built leaf(const Place& place, std::size_t begin, std::size_t count);
    Built interior(const Place& place, const Split& split, std::size_t begin, std::size_t count);

    Splitter splitter_;
    std::vector<std::uint32_t> stack_;  // items of the voxels between the root and this one
    std::size_t top_ = 0;
    Subtree out_;
};

}  // namespace nuvo
