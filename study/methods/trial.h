#pragma once

#include <numeric>
#include <vector>

#include "nuvo/octree/midpoint.h"
#include "paying_cut.h"

namespace nuvo::study {

/// What the program's own finder makes of planes: on which axes they are cut and what that saves.
/// By boxes alone.
class Trial {
  public:
    explicit Trial(const SplitQuery& query)
        : query_(query), planes_{}, options_{options()}, finder_(query.boxes, options_) {
        all_.resize(query.boxes.size());
        std::iota(all_.begin(), all_.end(), ItemId{0});
    }
    Trial(const Trial&) = delete;
    Trial& operator=(const Trial&) = delete;

    std::optional<PayingCut> cut(const Voxel& voxel, std::span<const ItemId> items,
                                 const Point3& planes) {
        planes_ = planes;
        return finder_.find(voxel, items);
    }
    std::span<const ItemId> all() const { return all_; }
    /// The boxes of those items.
    std::vector<Bounds3> boxes(std::span<const ItemId> items) const {
        std::vector<Bounds3> out;
        for (const ItemId item : items) out.push_back(query_.boxes[item]);
        return out;
    }

  private:
    BuildOptions options() {
        BuildOptions options;
        options.midpoint = [this](const SplitQuery&) { return std::optional<Point3>(planes_); };
        options.margin = query_.margin;
        return options;
    }

    const SplitQuery& query_;
    Point3 planes_;
    BuildOptions options_;
    CutFinder finder_;
    std::vector<ItemId> all_;
};

}  // namespace nuvo::study
