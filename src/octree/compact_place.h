#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "compact_split.h"

namespace nuvo {

/// What a whole tree is made of.
struct Recipe {
    BoxSpan boxes;
    const OctantTest& overlaps;
    Prices prices;
    CutRule rule;
    int threads;
};

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
        return {octant_box(split.voxel.bounds, split.voxel.cut, o), level + 1,
                allowance.share(split, o)};
    }
};

/// Octants of the items of the voxel that was split last, and space for another try.
struct SplitMasks {
    std::vector<std::uint8_t> kept;
    std::vector<std::uint8_t> tried;
};

/// The cut of a voxel with these items, if there is one that is worth trying; the octants of the
/// items are then in masks.kept. `mark(cut, items, masks)` sets the octants and returns their
/// counts. Where the sweep finds little, because it sees the items' boxes only, the centre is
/// tried, too; and where items as long as the voxel are not parted, the widest of the axes across
/// them.
template <typename Mark>
std::optional<Split> find_split(const Recipe& recipe, const Place& place, ItemSpan items,
                                SplitMasks& masks, Mark&& mark) {
    const Prices& prices = recipe.prices;
    constexpr double kLittle = 0.75;  // of the cost of a leaf; commonly half of it is left
    const std::size_t count = items.size();
    if (place.level >= CompactOctree::kMaxDepth || !prices.may_pay(count)) return std::nullopt;
    if (masks.kept.size() < count) masks.kept.resize(count);
    const auto attempt = [&](CutRule by, CutAxes axes,
                             std::vector<std::uint8_t>& out) -> std::optional<Split> {
        const std::optional<CutVoxel> cut = choose_cut(by, axes, place.voxel, items, recipe.boxes);
        if (!cut) return std::nullopt;
        return Split{*cut, mark(*cut, items, out.data())};
    };
    std::optional<Split> split = attempt(recipe.rule, CutAxes::kWide, masks.kept);
    const bool many = count >= kManyItems;
    const auto try_another = [&](CutRule by, CutAxes axes) {
        if (masks.tried.size() < count) masks.tried.resize(count);
        const std::optional<Split> other = attempt(by, axes, masks.tried);
        if (!other || (split && prices.after(*other, count) >= prices.after(*split, count))) return;
        split = other;
        std::swap(masks.kept, masks.tried);
    };
    if (many && recipe.rule == CutRule::kSweep &&
        (!split || prices.after(*split, count) > kLittle * prices.leaf(count)))
        try_another(CutRule::kSpatial, CutAxes::kWide);
    if (many && (!split || !prices.worth_trying(*split, count)))
        try_another(recipe.rule, CutAxes::kNext);
    if (!split || !place.allowance.permits(*split) || !prices.worth_trying(*split, count))
        return std::nullopt;
    return split;
}

}  // namespace nuvo
