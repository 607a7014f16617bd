#include "compact_plan.h"

#include <algorithm>
#include <numeric>

#include "nuvo/math/parallel.h"

// The top of the tree, where few voxels hold many items each: threads share the items of a voxel.
// Below it they share the voxels.

namespace nuvo {
namespace {

// A subtree is a task of at most this share of the items, but never smaller than kSmallestTask.
constexpr std::size_t kTasks = 64;
constexpr std::size_t kSmallestTask = 4096;
constexpr std::size_t kSmallestPart = 256;  // that tells how often a rule lists items
constexpr std::size_t kChunk = 8192;        // items of a voxel that a thread marks at a time

class Planner {
  public:
    explicit Planner(const Recipe& recipe) : recipe_(recipe) {}

    std::optional<Split> try_split(const PlanNode& node) {
        const std::optional<Split> split =
            find_split(recipe_, node.place, node.items, masks_,
                       [&](const CutVoxel& cut, ItemSpan items, std::uint8_t* masks) {
                           return mark(cut, items, masks);
                       });
        return split && split->occupied() != 0 ? split : std::nullopt;
    }

    // The items of the octants of the node that was split last; each chunk's in ranges of its own.
    std::array<BigVector<std::uint32_t>, 8> distribute(const PlanNode& node) const {
        std::array<BigVector<std::uint32_t>, 8> octants;
        for (unsigned o = 0; o < 8; ++o) octants[o].resize(node.split->counts[o]);
        const std::size_t chunks = chunks_of(node.items.size());
        std::vector<std::array<std::size_t, 8>> first(chunks);
        for (std::size_t i = 1; i < chunks; ++i) {
            const auto [begin, end] = chunk(i - 1, node.items.size());
            first[i] = count_octants(masks_.kept.data() + begin, end - begin);
            for (unsigned o = 0; o < 8; ++o) first[i][o] += first[i - 1][o];
        }
        for_each_index(recipe_.threads, chunks, [&](std::size_t i, int) {
            std::array<std::uint32_t*, 8> next;
            for (unsigned o = 0; o < 8; ++o) next[o] = octants[o].data() + first[i][o];
            const auto [begin, end] = chunk(i, node.items.size());
            for (std::size_t k = begin; k < end; ++k)
                for (unsigned mask = masks_.kept[k]; mask != 0; mask &= mask - 1)
                    *next[static_cast<unsigned>(std::countr_zero(mask))]++ = node.items[k];
        });
        return octants;
    }

  private:
    static std::size_t chunks_of(std::size_t items) { return (items + kChunk - 1) / kChunk; }
    static std::pair<std::size_t, std::size_t> chunk(std::size_t i, std::size_t items) {
        return {i * kChunk, std::min((i + 1) * kChunk, items)};
    }
    std::array<std::size_t, 8> mark(const CutVoxel& voxel, ItemSpan items, std::uint8_t* masks) {
        const std::size_t chunks = chunks_of(items.size());
        std::vector<std::array<std::size_t, 8>> counts(chunks);
        for_each_index(recipe_.threads, chunks, [&](std::size_t i, int) {
            const auto [begin, end] = chunk(i, items.size());
            const ItemSpan part = items.subspan(begin, end - begin);
            counts[i] = mark_octants(recipe_.boxes, recipe_.overlaps, voxel, part, masks + begin);
        });
        std::array<std::size_t, 8> sums{};
        for (const auto& part : counts)
            for (unsigned o = 0; o < 8; ++o) sums[o] += part[o];
        return sums;
    }

    const Recipe& recipe_;
    SplitMasks masks_;
};

// Down to a voxel of at most so many items, always to the octant that holds most.
PlanNode descend(PlanNode node, std::size_t most, const Recipe& recipe) {
    Planner planner(recipe);
    while (node.items.size() > most) {
        node.split = planner.try_split(node);
        if (!node.split) break;
        const auto& counts = node.split->counts;
        const auto fullest =
            static_cast<unsigned>(std::max_element(counts.begin(), counts.end()) - counts.begin());
        auto octants = planner.distribute(node);
        node = {node.place.octant(*node.split, fullest), std::move(octants[fullest]), {}, 0, {}, 0};
    }
    return node;
}

}  // namespace

std::vector<PlanNode> make_plan(const Place& root, const Recipe& recipe) {
    std::vector<PlanNode> plan(1);
    plan[0].place = root;
    plan[0].items.resize(recipe.boxes.size());
    std::iota(plan[0].items.begin(), plan[0].items.end(), 0U);
    const std::size_t task = std::max(kSmallestTask, recipe.boxes.size() / kTasks);
    Planner planner(recipe);
    for (std::size_t i = 0; i < plan.size(); ++i) {
        if (plan[i].items.size() <= task) continue;
        plan[i].split = planner.try_split(plan[i]);
        if (!plan[i].split) continue;
        const Split& split = *plan[i].split;
        plan[i].first_child = plan.size();
        auto octants = planner.distribute(plan[i]);
        std::vector<PlanNode> children;
        for (unsigned o = 0; o < 8; ++o)
            if (split.counts[o] != 0)
                children.push_back(
                    {plan[i].place.octant(split, o), std::move(octants[o]), {}, 0, {}, 0});
        std::move(children.begin(), children.end(), std::back_inserter(plan));
    }
    return plan;
}

double references_beside(CutRule other, const std::vector<PlanNode>& plan, const Recipe& recipe) {
    constexpr std::size_t kParts = 4;  // spread evenly over the items
    const std::size_t most = std::max(kSmallestPart, recipe.boxes.size() / kTasks);
    std::size_t items = 0;
    for (const PlanNode& node : plan)
        if (!node.split) items += node.items.size();
    Recipe changed = recipe;
    changed.rule = other;
    SubtreeBuilder by_rule(recipe);
    SubtreeBuilder by_other(changed);
    std::size_t references = 0;
    std::size_t of_other = 0;
    std::size_t before = 0;
    std::size_t part = 0;  // of those taken
    for (const PlanNode& node : plan) {
        if (node.split) continue;
        before += node.items.size();
        if (2 * kParts * before <= (2 * part + 1) * items) continue;
        part = (2 * kParts * before / items + 1) / 2;
        const PlanNode sample = descend(node, most, recipe);
        references += by_rule.build(sample.place, sample.items).items.size();
        of_other += by_other.build(sample.place, sample.items).items.size();
    }
    return of_other > 0 ? static_cast<double>(references) / static_cast<double>(of_other) : 1;
}

void carry_out(std::vector<PlanNode>& plan, const Recipe& recipe, Progress* progress) {
    std::vector<PlanNode*> tasks;
    std::size_t items = 0;
    for (PlanNode& node : plan) {
        if (node.split) continue;
        tasks.push_back(&node);
        items += node.items.size();
    }
    begin(progress, "primitives", items);
    std::vector<SubtreeBuilder> builders;
    for (int i = 0; i < recipe.threads; ++i) builders.emplace_back(recipe);
    for_each_index(recipe.threads, tasks.size(), [&](std::size_t i, int thread) {
        PlanNode& node = *tasks[i];
        node.subtree = builders[static_cast<std::size_t>(thread)].build(node.place, node.items);
        node.cost = node.subtree.cost;
        add(progress, node.items.size());
    });
    const Prices& prices = recipe.prices;
    for (std::size_t i = plan.size(); i-- > 0;) {
        PlanNode& node = plan[i];
        if (!node.split) continue;
        const double beam = prices.beam(node.place.voxel, node.items.size());
        node.cost = prices.interior();
        for (unsigned c = 0; c < node.split->octants(); ++c) {
            const PlanNode& child = plan[node.first_child + c];
            node.cost += Prices::share(child.place.voxel, node.place.voxel, beam) * child.cost;
        }
        const double as_leaf = prices.leaf(node.items.size());
        if (node.cost < as_leaf) continue;
        node.split.reset();
        const auto count = static_cast<std::uint32_t>(node.items.size());
        node.subtree = {
            CompactNode::leaf(0, count), as_leaf, {}, {node.items.begin(), node.items.end()}};
        node.cost = as_leaf;
    }
}

}  // namespace nuvo
