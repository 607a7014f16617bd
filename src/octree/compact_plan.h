#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compact_subtree.h"
#include "nuvo/math/big_vector.h"
#include "nuvo/math/progress.h"

namespace nuvo {

/// A node near the root: cut further, or the root of a subtree that one thread builds.
struct PlanNode {
    Place place;
    BigVector<std::uint32_t> items;
    std::optional<Split> split;   ///< none: the root of `subtree`
    std::size_t first_child = 0;  ///< the children stand side by side
    Subtree subtree;
    double cost = 0;  ///< of a beam that meets it
};

/// The upper levels, node 0 the root and every node before its children, cut until no node holds
/// more than a small share of the items, which does not depend on the number of threads.
std::vector<PlanNode> make_plan(const Place& root, const Recipe& recipe);

/// References by the recipe's rule as a multiple of those by another one, in a few parts of the
/// scene whose items are a small share of all.
double references_beside(CutRule other, const std::vector<PlanNode>& plan, const Recipe& recipe);

/// Builds the subtrees and takes back what does not pay.
void carry_out(std::vector<PlanNode>& plan, const Recipe& recipe, Progress* progress);

}  // namespace nuvo
