#pragma once

#include <optional>

#include "exact_kernel.h"
#include "fast/scene/fast_scene.h"
#include "leaf_boxes.h"
#include "nuvo/math/error_bounds.h"

namespace nuvo {

/// The nearest hit of one ray on the primitives that it is held against so far, by the exact
/// profile's predicates; boxes rule most of them out.
class NearestHit {
  public:
    using Kernel = ExactKernelOf<SceneStore>;

    /// Keeps references.
    NearestHit(const FastScene& scene, const Kernel& kernel, const Ray& ray)
        : scene_(scene), kernel_(kernel), ray_(kernel.prepare(ray)), slabs_(ray_) {}

    /// False: the ray surely misses all primitives of the scene.
    bool may_meet_any() const { return !slabs_.surely_missed(scene_.box(), end()); }
    /// Holds the ray against one more; returns whether its box did not rule it out.
    bool test(Slot slot) {
        const PrimitiveId id = scene_.id(slot);
        if (slabs_.surely_missed(scene_.primitives().item_boxes[id], end())) return false;
        kernel_.closest(ray_, {id, id + 1}, best_);
        if (best_ && best_->primitive == id) slot_ = slot;
        return true;
    }
    const std::optional<Kernel::Hit>& best() const { return best_; }
    /// What is hit; kNoSlot: nothing.
    Slot slot() const { return slot_; }

  private:
    double end() const { return best_ ? best_->root.high : kInfinity; }

    const FastScene& scene_;
    const Kernel& kernel_;
    ExactRay ray_;
    Slabs slabs_;
    std::optional<Kernel::Hit> best_;
    Slot slot_ = kNoSlot;
};

}  // namespace nuvo
