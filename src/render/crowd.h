#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "hull_planes.h"
#include "nuvo/octree/octree.h"
#include "nuvo/render/primitives.h"

namespace nuvo {

/// What is known of a leaf whose items no cut can part, because they lie in each other: found by a
/// few rays, it spares all others most of the tests. [numerics: crowds]
template <typename Kernel>
class Crowd {
  public:
    /// Fewer items are tested faster than looked up.
    static constexpr std::size_t kLeast = 64;

    Crowd(const Kernel& kernel, std::span<const ItemId> items)
        : kernel_(kernel), items_(items), hull_(kernel.hull(items)) {}

    std::span<const ItemId> items() const { return items_; }
    /// The ray surely meets none of the items.
    bool surely_missed(const ExactRay& ray) const { return hull_.surely_missed(ray); }

    /// The item to test first, and what may come before it if that is met.
    struct Front {
        PrimitiveId first = 0;
        std::vector<ItemId> rivals;
    };
    /// None: ask all.
    const Front* front(const Point3& eye) const {
        return last_ && last_->listed && eye == eye_ ? &last_->list : nullptr;
    }
    /// Among all items `winner` was nearest to a ray from `eye`.
    void won(const Point3& eye, PrimitiveId winner) {
        if (!(eye == eye_)) fronts_.clear();  // last_ with them
        eye_ = eye;
        last_ = &fronts_[winner];
        last_->list.first = winner;
        if (!is_due(*last_)) return;
        for (const ItemId item : items_)
            if (item != winner && !kernel_.hides(winner, eye, item))
                last_->list.rivals.push_back(item);
        room_ -= std::min(room_, last_->list.rivals.size());
    }

    /// What may block a way from the lit primitive to the light; none: ask all.
    const std::vector<ItemId>* blockers(const typename Kernel::Shadow& shadow) {
        if (!kernel_.lights_triangle(shadow)) return nullptr;
        Listed<std::vector<ItemId>>& shade = shades_[{*shadow.from, shadow.light}];
        if (is_due(shade)) {
            for (const ItemId item : items_)
                if (!kernel_.leaves_in_light(item, shadow)) shade.list.push_back(item);
            room_ -= std::min(room_, shade.list.size());
        }
        return shade.listed ? &shade.list : nullptr;
    }
    /// The item that blocked last.
    std::optional<ItemId> usual_blocker;

  private:
    // A list costs as much as some rays against all items.
    static constexpr int kPatience = 3;
    static constexpr std::size_t kRoom = std::size_t{1} << 20;  // items in all lists

    template <typename List>
    struct Listed {
        List list;
        int asked = 0;
        bool listed = false;
    };
    // To be listed now.
    template <typename List>
    bool is_due(Listed<List>& entry) const {
        if (entry.listed || ++entry.asked < kPatience || room_ == 0) return false;
        return entry.listed = true;
    }

    const Kernel& kernel_;
    std::span<const ItemId> items_;
    HullPlanes hull_;
    std::size_t room_ = kRoom;
    Point3 eye_;
    std::map<PrimitiveId, Listed<Front>> fronts_;  // of rays from eye_, by the winner
    Listed<Front>* last_ = nullptr;
    std::map<std::pair<PrimitiveId, const Light*>, Listed<std::vector<ItemId>>> shades_;
};

}  // namespace nuvo
