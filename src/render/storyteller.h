#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "nuvo/math/error_bounds.h"
#include "nuvo/render/explain.h"

namespace nuvo {

/// Writes down what happens to one ray after the other.
class Storyteller {
  public:
    /// What is told from now on belongs to that ray; `story` outlives the telling.
    void begin(RayStory& story, const Ray& ray, double t_end) {
        story_ = &story;
        story.ray = ray;
        story.t_end = t_end;
    }
    void search() { ++story_->searches; }
    void enter(const Node& leaf) {
        const auto [in, out] = way_through(leaf.voxel.bounds);
        story_->voxels.push_back({leaf.label, leaf.voxel.bounds, in, out, leaf.item_count, {}});
    }
    void tested(const TestStory& test) {
        auto& tests = story_->voxels.empty() ? story_->before : story_->voxels.back().tests;
        tests.push_back(test);
    }

  private:
    std::pair<double, double> way_through(const Bounds3& box) const {
        double in = 0;
        double out = kInfinity;
        for (int axis = 0; axis < 3; ++axis) {
            const double d = story_->ray.direction[axis];
            if (d == 0) continue;
            const double o = story_->ray.origin[axis];
            in = std::max(in, ((d > 0 ? box.min : box.max)[axis] - o) / d);
            out = std::min(out, ((d > 0 ? box.max : box.min)[axis] - o) / d);
        }
        return {in, std::max(in, out)};
    }

    RayStory* story_ = nullptr;
};

/// A search's counter that tells of voxels and searches.
struct TellingCounter {
    Storyteller* teller;
    void count_leaf(const Node& leaf) const { teller->enter(leaf); }
    void count_items(std::size_t) const {}
    void count_search() const { teller->search(); }
    void count_primitives(PrimitiveRange) const {}
};

/// `Kernel`, telling of each test of a primitive.
template <typename Kernel>
class TellingKernel : public Kernel {
  public:
    using typename Kernel::Hit;
    using typename Kernel::PreparedRay;
    using typename Kernel::Shadow;

    TellingKernel(const Kernel& kernel, Storyteller& teller) : Kernel(kernel), teller_(&teller) {}

    auto hit_of(const PreparedRay& ray, PrimitiveId id) const {
        return told(
            id, [&] { return own_hit(ray, id); },
            [&](const auto& hit) {
                return hit ? std::optional<double>(this->t(*hit)) : std::nullopt;
            });
    }
    void closest(const PreparedRay& ray, PrimitiveRange range, std::optional<Hit>& best) const {
        for (PrimitiveId id = range.first; id < range.last; ++id) {
            const std::optional<Hit> hit = hit_of(ray, id);
            if (hit && (!best || comes_first(ray, *hit, *best))) best = hit;
        }
    }
    bool blocks(const Shadow& shadow, PrimitiveRange range) const {
        for (PrimitiveId id = range.first; id < range.last; ++id)
            if (told(id, [&] { return Kernel::blocks(shadow, {id, id + 1}); })) return true;
        return false;
    }
    bool blocks_itself(const Shadow& shadow) const {
        if (!shadow.from) return false;
        return told(*shadow.from, [&] { return Kernel::blocks_itself(shadow); });
    }
    auto shadow_t(const Shadow& shadow, PrimitiveRange range) const {
        auto nearest = Kernel::kInfinity;
        for (PrimitiveId id = range.first; id < range.last; ++id)
            nearest = std::min(nearest, told(
                                            id,
                                            [&] {
                                                return Kernel::shadow_t(shadow, {id, id + 1});
                                            },
                                            [](auto t) {
                                                return t < Kernel::kInfinity
                                                           ? std::optional<double>(t)
                                                           : std::nullopt;
                                            }));
        return nearest;
    }

  private:
    std::optional<Hit> own_hit(const PreparedRay& ray, PrimitiveId id) const {
        std::optional<Hit> hit;
        Kernel::closest(ray, {id, id + 1}, hit);
        return hit;
    }
    bool comes_first(const PreparedRay& ray, const Hit& a, const Hit& b) const {
        if constexpr (requires { Kernel::precedes(ray, a, b); })
            return Kernel::precedes(ray, a, b);
        else
            return a.t < b.t || (a.t == b.t && a.primitive < b.primitive);
    }

    Stage stage_since(std::uint64_t wider, std::uint64_t exact) const {
        const auto [wider_now, exact_now] = stages();
        if (exact_now > exact) return Stage::kExact;
        return wider_now > wider ? Stage::kWider : Stage::kCheap;
    }
    std::pair<std::uint64_t, std::uint64_t> stages() const {
        if constexpr (requires { Kernel::stage_counts(); })
            return {Kernel::stage_counts().wider, Kernel::stage_counts().exact};
        return {0, 0};
    }
    // The test's answer, which is told, too; a bare yes has no t.
    template <typename Test, typename FindT>
    auto told(PrimitiveId id, Test&& test, FindT&& find_t) const {
        const auto [wider, exact] = stages();
        const auto answer = test();
        const std::optional<double> t = find_t(answer);
        teller_->tested({id, t.has_value(), t, stage_since(wider, exact)});
        return answer;
    }
    template <typename Test>
    bool told(PrimitiveId id, Test&& test) const {
        const auto [wider, exact] = stages();
        const bool answer = test();
        teller_->tested({id, answer, std::nullopt, stage_since(wider, exact)});
        return answer;
    }

    Storyteller* teller_;
};

}  // namespace nuvo
