// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_INTERLEAVED_RAYS_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_INTERLEAVED_RAYS_H_
#undef NUVO_RENDER_FAST_INTERLEAVED_RAYS_H_
#else
#define NUVO_RENDER_FAST_INTERLEAVED_RAYS_H_
#endif

#include <bit>
#include <cstring>
#include <span>
#include <utility>

#include "fast/rays/ray_block.h"
#include "fast/rays/ray_state.h"
#include "fast/rays/single_ray.h"
#include "fast/rays/single_ray_leaf.h"
#include "fast/simd/lanes.h"
#include "fast/simd/prefetch.h"
#include "nuvo/math/error_bounds.h"

// A node's boxes are met from near to far, as in Embree's single-ray kernels (Wald et al. 2014,
// "Embree: a kernel framework for efficient CPU ray tracing"), but 16 at a step and in the order
// of their node's cuts instead of sorted. What floats leave open is kept as a candidate with an
// interval, and decided by exact arithmetic at the end, if nothing that is surely nearer has come
// up.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// Walks batches of rays.
class InterleavedRays {
  public:
    /// At a time: more would fall out of the first cache.
    static constexpr std::size_t kInterleaved = 16;

    explicit InterleavedRays(SingleRays& rays) : rays_(rays), tree_(rays.tree()) {}

    /// At most kRayBatch rays; found[i] takes what ray i meets first, or kNoSlot.
    void run(std::span<const Ray> batch, Slot* found) {
        batch_ = batch;
        found_ = found;
        next_ = 0;
        for (RayState& state : states_) start_next(state);
        while (at_nodes_.count + at_leaves_.count > 0) {
            // A few steps at a leaf or at an end, with some left, would hardly overlap.
            do {
                step_all();
            } while (at_nodes_.count >= kInterleaved / 2);
            test_leaves();
            for (std::size_t count = finished_.restart(), i = 0; i < count; ++i) {
                RayState& state = *finished_.state[i];
                finish(state);
                start_next(state);
            }
        }
    }

  private:
    // The rays in one state. Read from the front while it is filled anew.
    struct Queue {
        std::size_t count = 0;
        RayState* state[kInterleaved + 1];
        HWY_INLINE std::size_t restart() { return std::exchange(count, std::size_t{0}); }
        HWY_INLINE void add(RayState& one, std::size_t once_or_not) {
            state[count] = &one;
            count += once_or_not;
        }
    };

    // In two passes, so that none waits for what it has just computed itself.
    HWY_NOINLINE void step_all() {
        const std::size_t count = at_nodes_.restart();
        for (std::size_t i = 0; i < count; ++i) step(*at_nodes_.state[i]);
        for (std::size_t i = 0; i < count; ++i) {
            RayState& state = *at_nodes_.state[i];
            state.take_next();
            queue(state);
        }
    }

    // In three passes, for the same reason.
    HWY_NOINLINE void test_leaves() {
        const std::size_t count = at_leaves_.restart();
        for (std::size_t i = 0; i < count; ++i) {
            RayState& state = *at_leaves_.state[i];
            test_leaf(state);
            with_hits_.add(state, static_cast<std::size_t>(state.block.kept != 0));
        }
        for (std::size_t hits = with_hits_.restart(), i = 0; i < hits; ++i)
            keep(*with_hits_.state[i]);
        for (std::size_t i = 0; i < count; ++i) {
            RayState& state = *at_leaves_.state[i];
            state.take_next();
            queue(state);
        }
    }

    // By arithmetic: branches here would be coin tosses.
    HWY_INLINE void queue(RayState& state) {
        static_assert(WideBvh::kLeaf == 1U << 31 && RayState::kFinished == 1U << 30);
        const std::size_t next = state.next;
        const std::size_t leaf = next >> 31;
        const std::size_t finished = (next >> 30 & 1) & ~leaf;
        at_leaves_.add(state, leaf);
        finished_.add(state, finished);
        at_nodes_.add(state, 1 - leaf - finished);
        if (!prefetches_) return;
        const auto at_leaf = reinterpret_cast<std::uintptr_t>(tree_.leaves.data()) +
                             (next & ~std::size_t{WideBvh::kLeaf}) * sizeof(std::uint32_t);
        const auto at_node = reinterpret_cast<std::uintptr_t>(tree_.nodes.data()) +
                             (next & ~std::size_t{RayState::kFinished}) * sizeof(WideNode);
        const std::uintptr_t place = ((at_leaf ^ at_node) & (0 - leaf)) ^ at_node;
        prefetch_lines(reinterpret_cast<const void*>(place), sizeof(WideNode));
    }

    // Lets the next ray of the batch take the place, if there is one.
    HWY_INLINE void start_next(RayState& state) {
        while (next_ < batch_.size()) {
            const std::size_t index = next_++;
            RayBlock& block = blocks_[index / RayLanes::kRays];
            const std::size_t lane = index % RayLanes::kRays;
            if (lane == 0) block.prepare(batch_.subspan(index), rays_.scene().frame(), tree_.reach);
            if ((block.valid >> lane & 1) != 0) {
                state.start(index, block.lanes);
                at_nodes_.add(state, 1);
                return;
            }
            found_[index] = rays_.brute_force(batch_[index]);
        }
    }

    // One node: what the ray meets of it waits on a level of its own.
    HWY_INLINE void step(RayState& state) const {
        const WideNode& node = tree_.nodes[state.next];
        const float* const inverses = state.rays->inverse[state.lane];
        const float* const near_adds = state.rays->near_add[state.lane];
        const float* const far_adds = state.rays->far_add[state.lane];
        const FacesOnRay& faces = kFacesBySigns[state.signs];
        Floats first(0.0F);
        Floats last(state.best);
        for (int axis = 0; axis < 3; ++axis) {
            const Floats inverse(inverses[axis]);
            first = max(mul_add(Floats::load(node.face + faces.near[axis]), inverse,
                                Floats(near_adds[axis])),
                        first);
            last = min(
                mul_add(Floats::load(node.face + faces.far[axis]), inverse, Floats(far_adds[axis])),
                last);
        }
        alignas(64) static constexpr std::int32_t kShift[kWideLanes] = {
            0, 0, 4, 4, 8, 8, 12, 12, 16, 16, 20, 20, 24, 24, 28, 28};
        const Ints order = Ints::pairs(node.order[state.signs]) >> Ints::load(kShift);
        const Floats entry = first.permuted(order);
        RayState::Level& level = *state.top;
        entry.store(level.entry);
        Ints::load(node.child).permuted(order).store(level.child);
        level.waiting = (entry <= last.permuted(order)).bits();
        state.top += static_cast<std::ptrdiff_t>(level.waiting != 0);
    }

    HWY_INLINE void test_leaf(RayState& state) const {
        const std::uint32_t* const words = tree_.leaves.data() + (state.next & ~WideBvh::kLeaf);
        WideLeafHead head;
        std::memcpy(&head, words, sizeof head);
        const Slot* const slots = words + kLeafHeadWords;
        const std::uint32_t triangles = head.triangles;
        const std::uint32_t spheres = head.spheres;
        const std::uint32_t others = head.others;
        const Slot* const other_slots = slots + triangles + spheres;
        const auto* const centers = reinterpret_cast<const float*>(other_slots + others);
        const auto* const corners =
            reinterpret_cast<const std::uint16_t*>(centers + std::size_t{4} * spheres);
        if (head.finest_unit() < state.rays->least_unit(state.lane)) {
            add_open(state, slots, triangles + spheres + others);
            return;
        }
        const RayAtLeaf at(*state.rays, state.lane, head, state.next_entry);
        in_blocks(triangles, [&](auto block, std::uint32_t i) HWY_ATTR {
            constexpr std::size_t kLanes = block;
            take(state, at,
                 test_triangles<kLanes>(at, corners + i, triangles, front_only<kLanes>(slots + i)),
                 slots + i, triangles - i);
        });
        const Slot* const sphere_slots = slots + triangles;
        in_blocks(spheres, [&](auto block, std::uint32_t i) HWY_ATTR {
            constexpr std::size_t kLanes = block;
            take(state, at,
                 test_spheres<kLanes>(at, centers + i, spheres, spheres - i,
                                      front_only<kLanes>(sphere_slots + i)),
                 sphere_slots + i, spheres - i);
        });
        if (others != 0) add_open(state, other_slots, others);
    }

    // Few fill more than 8 lanes; the rest take 16 at once.
    template <typename Test>
    HWY_INLINE static void in_blocks(std::uint32_t count, const Test& test) {
        for (std::uint32_t i = 0; i < count; i += kMostLeafLanes)
            if (count - i > kLeafLanes)
                test(std::integral_constant<std::size_t, kMostLeafLanes>(), i);
            else
                test(std::integral_constant<std::size_t, kLeafLanes>(), i);
    }

    // What a leaf's last block of primitives says waits with its ray until all rays' leaves are
    // tested.
    template <std::size_t N>
    HWY_INLINE void take(RayState& state, const RayAtLeaf& at, const LeafHits<N>& hits,
                         const Slot* slots, std::uint32_t count) const {
        using LeafFloats = Lanes<float, N>;
        using LeafMask = LaneMask<float, N>;
        if (state.block.kept != 0) keep(state);
        const LeafFloats behind(at.behind);
        const LeafMask nearer = hits.low <= LeafFloats(state.best);
        const LeafMask sure = hits.sure & (hits.low > behind);
        const LeafMask perhaps = (hits.sure | hits.open) & nearer & (hits.high >= behind);
        hits.low.store(state.block.low);
        hits.high.store(state.block.high);
        state.block.slots = slots;
        state.block.sure = sure.bits();
        state.block.kept = perhaps.bits() & first_lanes<N>(count);
    }

    HWY_NOINLINE void keep(RayState& state) const {
        const RayState::Block& block = state.block;
        for (std::uint32_t kept = std::exchange(state.block.kept, 0U); kept != 0;
             kept &= kept - 1) {
            const int lane = std::countr_zero(kept);
            const bool is_sure = (block.sure >> lane & 1) != 0;
            if (block.low[lane] > state.best) continue;
            add(state,
                {block.low[lane], block.high[lane], block.slots[lane] & ~kFrontOnly, is_sure});
            if (is_sure) state.best = std::min(state.best, block.high[lane]);
        }
        drop_levels(state);
    }

    // Forgets what waits behind the nearest sure hit.
    HWY_INLINE void drop_levels(RayState& state) const {
        RayState::Level* free = state.levels + 1;
        for (RayState::Level* level = free; level != state.top; ++level) {
            level->waiting &= (Floats::load(level->entry) <= Floats(state.best)).bits();
            if (level->waiting == 0) continue;
            if (level != free) *free = *level;
            ++free;
        }
        state.top = free;
    }

    HWY_NOINLINE void add_open(RayState& state, const Slot* slots, std::uint32_t count) const {
        for (std::uint32_t i = 0; i < count; ++i)
            add(state, {-kFloatInfinity, kFloatInfinity, slots[i] & ~kFrontOnly, false});
    }

    void add(RayState& state, const RayCandidate& candidate) const {
        if (state.candidate_count == RayState::kMaxCandidates) {
            state.drop_behind_best();
            if (state.candidate_count > RayState::kMaxCandidates / 2) decide(state);
        }
        state.candidates[state.candidate_count++] = candidate;
    }
    HWY_NOINLINE void decide(RayState& state) const {
        const auto exact = rays_.decide(batch_[state.index], *state.rays, state.lane,
                                        {state.candidates, state.candidate_count});
        state.candidate_count = 0;
        if (!exact) return;
        state.candidates[state.candidate_count++] = *exact;
        state.best = std::min(state.best, exact->high);
    }

    HWY_INLINE void finish(RayState& state) const {
        if (state.candidate_count > 1) state.drop_behind_best();
        if (state.candidate_count == 0) {
            found_[state.index] = kNoSlot;
            return;
        }
        // One primitive, sure in one leaf, is left: nothing to compare.
        bool alone = state.candidates[0].sure;
        for (std::uint32_t i = 1; i < state.candidate_count; ++i)
            alone &= state.candidates[i].slot == state.candidates[0].slot;
        if (!alone) decide(state);
        found_[state.index] = state.candidate_count == 0 ? kNoSlot : state.candidates[0].slot;
    }

    SingleRays& rays_;
    const WideBvh& tree_;
    std::span<const Ray> batch_;
    Slot* found_ = nullptr;
    const bool prefetches_ = tree_.memory_bytes() > SingleRays::kCached;
    std::size_t next_ = 0;
    Queue at_nodes_;
    Queue at_leaves_;
    Queue with_hits_;
    Queue finished_;
    RayState states_[kInterleaved];
    RayBlock blocks_[kRayBatch / RayLanes::kRays];
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_INTERLEAVED_RAYS_H_
