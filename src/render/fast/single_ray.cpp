#include "fast/single_ray.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/single_ray.cpp"
#include <hwy/foreach_target.h>

#include "fast/lanes.h"
#include "fast/single_ray_leaf.h"

// A node's boxes are met from near to far, as in Embree's single-ray kernels (Wald et al. 2014),
// but 16 at a step. What floats leave open is kept as a candidate with an interval, and decided by
// exact arithmetic at the end, if nothing that is surely nearer has come up.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class SingleWalk {
  public:
    HWY_INLINE SingleWalk(const SingleRays& rays, const Ray& world, const LocalRay& ray)
        : rays_(rays), world_(world), ray_(ray), tree_(rays.tree()) {}

    HWY_INLINE Slot run() {
        std::uint64_t* top = waiting_;
        std::uint64_t next = 0;  // the root
        for (;;) {
            const auto place = static_cast<std::uint32_t>(next);
            if ((place & WideOctree::kLeaf) != 0) {
                test_leaf(tree_.leaves.data() + (place & ~WideOctree::kLeaf), entry_of(next));
            } else if (step(tree_.nodes[place], top, next)) {
                continue;
            }
            do {
                if (top == waiting_) return nearest();
                next = *--top;
            } while (entry_of(next) > best_);
        }
    }

  private:
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();
    static constexpr std::size_t kMaxCandidates = 64;

    // A voxel still to be visited: the parameter of its entry, never negative, as bits in the upper
    // half, so that nearer ones compare less.
    static HWY_INLINE float entry_of(std::uint64_t waiting) {
        return std::bit_cast<float>(static_cast<std::uint32_t>(waiting >> 32));
    }

    // Puts what the ray meets of the node on the stack, the nearest into `next`; false: nothing.
    HWY_INLINE bool step(const WideNode& node, std::uint64_t*& top, std::uint64_t& next) const {
        constexpr std::uint32_t kToFar = 3 * kWideLanes;
        Floats first(0.0F);
        Floats last(best_);
        for (int axis = 0; axis < 3; ++axis) {
            const float* const near = node.low[0] + ray_.near_offset[axis];
            const float* const far =
                node.low[0] + (ray_.near_offset[axis] < kToFar ? ray_.near_offset[axis] + kToFar
                                                               : ray_.near_offset[axis] - kToFar);
            const Floats inverse(ray_.inverse[axis]);
            first = max(mul_add(Floats::load(near), inverse, Floats(ray_.near_add[axis])), first);
            last = min(mul_add(Floats::load(far), inverse, Floats(ray_.far_add[axis])), last);
        }
        std::uint32_t met = (first <= last).bits();
        if (met == 0) return false;
        alignas(64) float entry[kWideLanes];
        first.store(entry);
        next = waiting(entry, node, met);
        for (met &= met - 1; met != 0; met &= met - 1) {
            std::uint64_t one = waiting(entry, node, met);
            if (one < next) std::swap(one, next);
            // Kept sorted, the nearest on top.
            std::uint64_t* place = top++;
            *place = one;
        }
        return true;
    }
    static HWY_INLINE std::uint64_t waiting(const float* entry, const WideNode& node,
                                            std::uint32_t met) {
        const int lane = std::countr_zero(met);
        return static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(entry[lane])) << 32 |
               node.child[lane];
    }

    HWY_INLINE void test_leaf(const std::uint32_t* words, float entry) {
        WideLeafHead head;
        std::memcpy(&head, words, sizeof head);
        const Slot* const slots = words + kLeafHeadWords;
        const std::uint32_t copied = head.triangles + head.spheres;
        if (head.unit < ray_.least_unit) {
            add_open(slots, copied + head.others);
            return;
        }
        const RayAtLeaf at(ray_, head, entry);
        const std::uint32_t* const data = slots + copied + head.others;
        const auto* const spheres = reinterpret_cast<const float*>(data);
        const auto* const corners =
            reinterpret_cast<const std::uint16_t*>(data + std::size_t{4} * head.spheres);
        for (std::uint32_t i = 0; i < head.triangles; i += kWideLanes)
            take(test_triangles(at, corners + i, head.triangles, rays_.bounds_scale()), slots + i,
                 head.triangles - i);
        for (std::uint32_t i = 0; i < head.spheres; i += kWideLanes)
            take(test_spheres(at, spheres + i, head.spheres, rays_.bounds_scale()),
                 slots + head.triangles + i, head.spheres - i);
        if (head.others != 0) add_open(slots + copied, head.others);
    }

    HWY_INLINE void take(const LeafHits& hits, const Slot* slots, std::uint32_t count) {
        const std::uint32_t lanes = count < kWideLanes ? (1U << count) - 1 : 0xffffU;
        const Floats behind(ray_.behind);
        const RayMask nearer = hits.low <= Floats(best_);
        const RayMask ahead = hits.low > behind;
        const std::uint32_t sure = (hits.sure & nearer & ahead).bits() & lanes;
        const std::uint32_t open =
            (without(hits.open | hits.sure, hits.sure & ahead) & nearer & (hits.high >= behind))
                .bits() &
            lanes;
        if ((sure | open) != 0) keep(hits, slots, sure, open);
    }

    HWY_NOINLINE void keep(const LeafHits& hits, const Slot* slots, std::uint32_t sure,
                           std::uint32_t open) {
        alignas(64) float low[kWideLanes];
        alignas(64) float high[kWideLanes];
        hits.low.store(low);
        hits.high.store(high);
        for (std::uint32_t lanes = sure | open; lanes != 0; lanes &= lanes - 1) {
            const int lane = std::countr_zero(lanes);
            const bool is_sure = (sure >> lane & 1) != 0;
            if (low[lane] > best_) continue;
            add({low[lane], high[lane], slots[lane], is_sure});
            if (is_sure) best_ = std::min(best_, high[lane]);
        }
    }

    HWY_NOINLINE void add_open(const Slot* slots, std::uint32_t count) {
        for (std::uint32_t i = 0; i < count; ++i) add({-kInfinity, kInfinity, slots[i], false});
    }

    void add(const RayCandidate& candidate) {
        if (count_ == kMaxCandidates) {
            drop_behind_best();
            if (count_ > kMaxCandidates / 2) decide();
        }
        candidates_[count_++] = candidate;
    }
    void drop_behind_best() {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            const RayCandidate candidate = candidates_[i];
            if (candidate.low <= best_) candidates_[kept++] = candidate;
        }
        count_ = kept;
    }
    HWY_NOINLINE void decide() {
        const auto exact = rays_.decide(world_, ray_, {candidates_, count_});
        count_ = 0;
        if (!exact) return;
        candidates_[count_++] = *exact;
        best_ = std::min(best_, exact->high);
    }

    HWY_INLINE Slot nearest() {
        if (count_ == 0) return kNoSlot;
        if (count_ > 1) drop_behind_best();
        bool alone = candidates_[0].sure;
        for (std::size_t i = 1; i < count_; ++i)
            alone &= candidates_[i].slot == candidates_[0].slot;
        if (!alone) decide();
        return count_ == 0 ? kNoSlot : candidates_[0].slot;
    }

    const SingleRays& rays_;
    const Ray& world_;
    const LocalRay& ray_;
    const WideOctree& tree_;
    float best_ = kInfinity;  // the nearest sure hit's upper bound
    std::size_t count_ = 0;
    RayCandidate candidates_[kMaxCandidates];
    std::uint64_t waiting_[WideOctree::kMaxWaiting];
};

Slot walk_single(const SingleRays& rays, const Ray& world, const LocalRay& ray) {
    return SingleWalk(rays, world, ray).run();
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/dispatch.h"

namespace nuvo {

SingleRays::SingleRays(const FastScene& scene, InstructionSet isa, bool redo_exactly)
    : scene_(scene),
      kernel_(scene.scene(), scene.primitives(), std::nullopt),
      tree_(scene),
      bounds_scale_(redo_exactly ? 1.0F : 0.0F),
      walk_(NUVO_FOR_ISA(resolved(isa), walk_single)) {}

std::vector<RayAnswer> SingleRays::closest_hits(std::span<const Ray> rays) const {
    std::vector<RayAnswer> answers;
    answers.reserve(rays.size());
    for (const Ray& ray : rays) {
        const LocalRay local(ray, scene_.frame(), tree_.reach);
        answers.push_back(local.valid ? answer(ray, walk_(*this, ray, local))
                                      : answer_by_force(ray));
    }
    return answers;
}

std::optional<RayCandidate> SingleRays::decide(const Ray& ray, const LocalRay& local,
                                               std::span<const RayCandidate> candidates) const {
    const ExactRay prepared = kernel_.prepare(ray);
    std::optional<Kernel::Hit> best;
    Slot slot = kNoSlot;
    for (const RayCandidate& candidate : candidates) {
        const auto hit = kernel_.hit_of(prepared, scene_.id(candidate.slot));
        if (!hit || (best && !kernel_.precedes(prepared, *hit, *best))) continue;
        best = hit;
        slot = candidate.slot;
    }
    if (!best) return std::nullopt;
    // Rounded to float, with the advance's and the origin's errors: |d| >= 1.
    const double s = best->root.t * local.scale - local.advance;
    const double slack = 4 * kFloatUnit * std::fabs(s) + 4 * local.error +
                         2 * root_tolerance() * (std::fabs(s) + local.advance) +
                         std::numeric_limits<float>::min();
    return RayCandidate{static_cast<float>(s - slack), static_cast<float>(s + slack), slot, true};
}

RayAnswer SingleRays::answer_for(const std::optional<Kernel::Hit>& hit) const {
    RayAnswer answer;
    answer.t = std::numeric_limits<double>::infinity();
    if (!hit) return answer;
    const PrimitiveSource& source = kernel_.source(hit->primitive);
    return {true, scene_.scene().objects[source.object].shape_index, source.triangle,
            hit->root.t};
}

RayAnswer SingleRays::answer(const Ray& ray, Slot slot) const {
    if (slot == kNoSlot) return answer_for(std::nullopt);
    return answer_for(kernel_.hit_of(kernel_.prepare(ray), scene_.id(slot)));
}

RayAnswer SingleRays::answer_by_force(const Ray& ray) const {
    std::optional<Kernel::Hit> best;
    kernel_.closest(kernel_.prepare(ray), scene_.primitives().all(), best);
    return answer_for(best);
}

}  // namespace nuvo
#endif
