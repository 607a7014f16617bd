#include "structures/grid.h"

#include <algorithm>
#include <cmath>

namespace nuvo::study {

Grid::Grid(std::span<const Bounds3> boxes, const OverlapTest& overlaps, double margin,
           double density) {
    constexpr int kMostCells = 512;  // on an axis
    for (const Bounds3& box : boxes) box_ = box_.extended(box.inflated(margin));
    const Vector3 w = box_.widths();
    const double volume = std::max(w.x * w.y * w.z, 0x1p-1000);
    const double per_length = std::cbrt(density * static_cast<double>(boxes.size()) / volume);
    for (int k = 0; k < 3; ++k) {
        cells_[k] = std::clamp(static_cast<int>(std::lround(w[k] * per_length)), 1, kMostCells);
        width_[k] = w[k] / cells_[k];
    }
    std::vector<std::vector<ItemId>> lists(static_cast<std::size_t>(cells_[0]) * cells_[1] *
                                           cells_[2]);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const auto item = static_cast<ItemId>(i);
        const Bounds3 box = boxes[i].inflated(margin);
        std::array<int, 3> low{}, high{}, cell{};
        for (int k = 0; k < 3; ++k) {
            low[k] = cell_of(k, box.min[k]);
            high[k] = cell_of(k, box.max[k]);
        }
        for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2])
            for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1])
                for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0]) {
                    Bounds3 own;
                    for (int k = 0; k < 3; ++k) {
                        own.min[k] = face(k, cell[k]);
                        own.max[k] = face(k, cell[k] + 1);
                    }
                    if (!overlaps || overlaps(item, own.inflated(margin)))
                        lists[index_of(cell)].push_back(item);
                }
    }
    first_.push_back(0);
    for (const auto& list : lists) {
        items_.insert(items_.end(), list.begin(), list.end());
        first_.push_back(static_cast<std::uint32_t>(items_.size()));
    }
}

int Grid::cell_of(int axis, double at) const {
    if (!(width_[axis] > 0)) return 0;
    return std::clamp(static_cast<int>(std::floor((at - box_.min[axis]) / width_[axis])), 0,
                      cells_[axis] - 1);
}

Sizes Grid::sizes() const {
    return {first_.size() - 1, items_.size(), 1,
            first_.size() * sizeof(std::uint32_t) + items_.size() * sizeof(ItemId)};
}

}  // namespace nuvo::study
