#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "direction_cells.h"
#include "hull_planes.h"
#include "leaf_boxes.h"
#include "nuvo/octree/octree.h"
#include "nuvo/render/primitives.h"

namespace nuvo {

/// What is known of a leaf of many items, which no cut could part: boxes below the margin of
/// voxels, and of items that lie in each other what a few rays found, which spares all others most
/// of the tests. [numerics: crowds]
template <typename Kernel>
class Crowd {
  public:
    /// Fewer items are tested faster than looked up.
    static constexpr std::size_t kLeast = 64;

    Crowd(const Kernel& kernel, const Primitives& primitives, std::span<const ItemId> items)
        : kernel_(kernel),
          items_(items),
          hull_(kernel.hull(items)),
          boxes_of_items_(primitives.item_boxes),
          boxes_(items, primitives.item_boxes) {}

    const LeafBoxes& boxes() const { return boxes_; }
    /// What a ray through `point` in direction d may meet, for a point that many rays share; none:
    /// not known.
    std::optional<std::span<const ItemId>> towards(const Point3& point, const Vector3& d) {
        Around* around = nullptr;
        for (Around& known : around_)
            if (known.point == point) around = &known;
        if (!around) {
            if (around_.size() == kPoints) return std::nullopt;
            around = &around_.emplace_back(point);
        }
        if (around->asked < kRaysForCells && ++around->asked == kRaysForCells) {
            around->cells = std::make_unique<DirectionCells>(point);
            for (const ItemId item : items_) {
                kernel_.add_to(*around->cells, item, boxes_of_items_[item]);
                if (around->cells->size() > DirectionCells::kRoom) {
                    around->cells.reset();  // and asked for no more
                    break;
                }
            }
        }
        if (!around->cells) return std::nullopt;
        return around->cells->towards(
            d, [&](ItemId item) { kernel_.add_to(*around->cells, item, boxes_of_items_[item]); });
    }
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
    /// Among all items `winner` was nearest to a ray from `eye`, as so many tests told.
    void won(const Point3& eye, PrimitiveId winner, std::size_t tests) {
        if (!(eye == eye_)) fronts_.clear();  // last_ with them
        eye_ = eye;
        last_ = &fronts_[winner];
        last_->list.first = winner;
        if (!is_due(*last_, tests)) return;
        for (const ItemId item : items_)
            if (item != winner && !kernel_.hides(winner, eye, item))
                last_->list.rivals.push_back(item);
        room_ -= std::min(room_, last_->list.rivals.size());
    }

    /// Whether any item blocks the way, which `blocks` tells of one.
    template <typename Blocks>
    bool blocked(const typename Kernel::Shadow& shadow, Blocks&& blocks) {
        if (surely_missed(shadow.ray)) return false;
        if (usual_blocker_ && blocks(*usual_blocker_)) return true;
        std::size_t tests = 0;
        const auto blocks_now = [&](ItemId item) {
            ++tests;
            if (!blocks(item)) return false;
            usual_blocker_ = item;
            return true;
        };
        Listed<LeafBoxes>* const shade = shade_of(shadow);
        const bool listed = shade != nullptr && shade->listed;
        const auto visit = [&] {
            if (shadow.light->kind != Light::Kind::kDirectional) {
                const auto some = towards(shadow.light->location, -shadow.ray.direction());
                if (some && (!listed || some->size() < shade->list.items().size()))
                    return std::any_of(some->begin(), some->end(), blocks_now);
            }
            return (listed ? shade->list : boxes_)
                .visit(
                    shadow.ray, [&] { return shadow.end; }, blocks_now);
        };
        const bool found = visit();
        if (shade != nullptr && is_due(*shade, tests)) list_blockers(shadow, *shade);
        return found;
    }

  private:
    static constexpr std::size_t kTestsOfList = 6;              // for each item that it is made of
    static constexpr std::size_t kRoom = std::size_t{1} << 20;  // items in all lists
    static constexpr std::size_t kRoomOfShade = 32;             // a list itself, in items

    // Cells cost some ten thousand tests of an item; eyes and point lights are few.
    static constexpr int kRaysForCells = 256;
    static constexpr std::size_t kPoints = 64;

    struct Around {
        explicit Around(const Point3& p) : point(p) {}
        Point3 point;
        int asked = 0;
        std::unique_ptr<DirectionCells> cells;
    };
    template <typename List>
    struct Listed {
        List list;
        std::size_t tests = 0;  // while it was not listed
        bool listed = false;
    };
    // To be listed now, after so many tests more: when rays without a list have cost as much.
    template <typename List>
    bool is_due(Listed<List>& entry, std::size_t tests) const {
        if (entry.listed) return false;
        entry.tests += tests;
        entry.listed = entry.tests >= kTestsOfList * items_.size() && room_ > 0;
        return entry.listed;
    }

    // Of what may block a way from the lit primitive to the light; null: nothing is listed of it,
    // nor will be.
    Listed<LeafBoxes>* shade_of(const typename Kernel::Shadow& shadow) {
        if (!kernel_.lights_triangle(shadow)) return nullptr;
        const auto known = shades_.find({*shadow.from, shadow.light});
        if (known != shades_.end()) return &known->second;
        if (room_ < kRoomOfShade) return nullptr;
        room_ -= kRoomOfShade;
        return &shades_[{*shadow.from, shadow.light}];
    }
    void list_blockers(const typename Kernel::Shadow& shadow, Listed<LeafBoxes>& shade) {
        shade.list = LeafBoxes(boxes_, boxes_of_items_,
                               [&](ItemId item) { return !kernel_.leaves_in_light(item, shadow); });
        room_ -= std::min(room_, shade.list.items().size());
    }

    const Kernel& kernel_;
    std::span<const ItemId> items_;
    HullPlanes hull_;
    std::span<const Bounds3> boxes_of_items_;
    LeafBoxes boxes_;
    std::vector<Around> around_;
    std::optional<ItemId> usual_blocker_;  // the last one
    std::size_t room_ = kRoom;
    Point3 eye_;
    std::map<PrimitiveId, Listed<Front>> fronts_;  // of rays from eye_, by the winner
    Listed<Front>* last_ = nullptr;
    std::map<std::pair<PrimitiveId, const Light*>, Listed<LeafBoxes>> shades_;
};

}  // namespace nuvo
