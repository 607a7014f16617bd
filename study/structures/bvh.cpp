#include <array>
#include <numeric>

#include "structures/box_tree.h"

namespace nuvo::study {
namespace {

constexpr int kBins = 16;

struct Bin {
    Bounds3 box;
    std::size_t count = 0;
    void add(const Bin& other) {
        box = box.extended(other.box);
        count += other.count;
    }
    double cost() const { return count == 0 ? 0 : box.surface_area() * static_cast<double>(count); }
};

int bin_of(double center, double low, double high) {
    return std::clamp(static_cast<int>(kBins * ((center - low) / (high - low))), 0, kBins - 1);
}

struct Parting {
    int axis = -1;
    int bin = 0;  // the first on the upper side
    double cost = 0;
};

Parting best_parting(std::span<const Bounds3> boxes, std::span<const ItemId> items,
                     const Bounds3& centers, double leaf_cost, double step_cost) {
    Parting best;
    best.cost = leaf_cost;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = centers.min[axis], high = centers.max[axis];
        if (!(low < high)) continue;
        std::array<Bin, kBins> bins;
        for (const ItemId item : items) {
            Bin& bin =
                bins[static_cast<std::size_t>(bin_of(boxes[item].center()[axis], low, high))];
            bin.add({boxes[item], 1});
        }
        std::array<double, kBins> above{};
        Bin sum;
        for (std::size_t i = kBins; i-- > 1;) {
            sum.add(bins[i]);
            above[i] = sum.cost();
        }
        sum = {};
        for (std::size_t i = 1; i < kBins; ++i) {
            sum.add(bins[i - 1]);
            if (sum.count == 0 || sum.count == items.size()) continue;
            const double cost = step_cost + sum.cost() + above[i];
            if (cost < best.cost) best = {axis, static_cast<int>(i), cost};
        }
    }
    return best;
}

}  // namespace

Bvh::Bvh(std::span<const Bounds3> boxes, double step) : boxes_(boxes), step_(step) {
    items_.resize(boxes.size());
    std::iota(items_.begin(), items_.end(), ItemId{0});
    nodes_.emplace_back();
    build(0, items_);
}

void Bvh::build(std::uint32_t node, std::span<ItemId> items) {
    Bounds3 box, centers;
    for (const ItemId item : items) {
        box = box.extended(boxes_[item]);
        const Point3 center = boxes_[item].center();
        centers = centers.extended(Bounds3{center, center});
    }
    nodes_[node].box = box;
    const double area = box.empty() ? 0 : box.surface_area();
    const Parting parting = best_parting(boxes_, items, centers,
                                         area * static_cast<double>(items.size()), step_ * area);
    if (parting.axis < 0) {
        nodes_[node].first = static_cast<std::uint32_t>(items.data() - items_.data());
        nodes_[node].count = static_cast<std::uint32_t>(items.size());
        return;
    }
    const double low = centers.min[parting.axis], high = centers.max[parting.axis];
    const auto middle = std::stable_partition(items.begin(), items.end(), [&](ItemId item) {
        return bin_of(boxes_[item].center()[parting.axis], low, high) < parting.bin;
    });
    const auto left = static_cast<std::size_t>(middle - items.begin());
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].first = first;
    nodes_[node].leaf = false;
    nodes_.resize(nodes_.size() + 2);
    build(first, items.first(left));
    build(first + 1, items.subspan(left));
}

}  // namespace nuvo::study
