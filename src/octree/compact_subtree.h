#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compact_place.h"

namespace nuvo {

/// A finished subtree without its root: nodes and runs, with places that count from 0.
struct Subtree {
    CompactNode root;
    double cost = 0;  ///< of a beam that meets it, as Prices gives it
    std::vector<CompactNode> nodes;
    std::vector<std::uint32_t> items;
};

/// Builds subtrees one after another. One for each thread: it keeps its buffers.
class SubtreeBuilder {
  public:
    explicit SubtreeBuilder(const Recipe& recipe) : recipe_(recipe) {}

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
    Built leaf(Run run);
    Built interior(const Place& place, const Split& split, Run run);
    ItemSpan items(Run run) const { return ItemSpan(stack_).subspan(run.begin, run.count); }

    Recipe recipe_;
    SplitMasks masks_;
    std::vector<std::uint32_t> stack_;  // items of the voxels between the root and this one
    std::size_t top_ = 0;
    Subtree out_;
};

}  // namespace nuvo
