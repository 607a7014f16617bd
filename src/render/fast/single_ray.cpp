#include "fast/single_ray.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>

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

class Flights {
  public:
    static constexpr std::uint32_t kFlights = 8;

    Flights(const SingleRays& rays, std::span<const Ray> batch, Slot* found)
        : rays_(rays), tree_(rays.tree()), batch_(batch), found_(found) {}

    void run() {
        for (std::uint32_t i = 0; i < kFlights; ++i) depart(flights_[i], i);
        while (at_nodes_.count + at_leaves_.count > 0) {
            for (std::uint32_t count = at_nodes_.restart(), i = 0; i < count; ++i) {
                const std::uint32_t number = at_nodes_.flight[i];
                step(flights_[number]);
                queue(number);
            }
            if (at_leaves_.count * 2 < kFlights && at_nodes_.count > 0) continue;
            for (std::uint32_t count = at_leaves_.restart(), i = 0; i < count; ++i) {
                const std::uint32_t number = at_leaves_.flight[i];
                test_leaf(flights_[number]);
                flights_[number].take_next();
                queue(number);
            }
        }
    }

  private:
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();

    // The numbers of flights in one state. Read from the front while it is filled anew.
    struct Queue {
        std::uint32_t count = 0;
        std::uint32_t flight[kFlights + 1];
        HWY_INLINE std::uint32_t restart() { return std::exchange(count, 0U); }
        HWY_INLINE void add(std::uint32_t number, bool really) {
            flight[count] = number;
            count += really ? 1 : 0;
        }
    };

    HWY_INLINE void queue(std::uint32_t number) {
        RayFlight& flight = flights_[number];
        if (flight.next == RayFlight::kLanded) {
            land(flight);
            depart(flight, number);
            return;
        }
        const bool leaf = (flight.next & WideOctree::kLeaf) != 0;
        at_leaves_.add(number, leaf);
        at_nodes_.add(number, !leaf);
    }

    // Lets the next ray of the batch take the place, if there is one.
    void depart(RayFlight& flight, std::uint32_t number) {
        while (next_ < batch_.size()) {
            const std::size_t index = next_++;
            flight.ray = LocalRay(batch_[index], rays_.scene().frame(), tree_.reach);
            if (flight.ray.valid) {
                flight.start(index);
                at_nodes_.add(number, true);
                return;
            }
            found_[index] = rays_.by_force(batch_[index]);
        }
    }

    // One node: what the ray meets of it waits on a level of its own.
    HWY_INLINE void step(RayFlight& flight) const {
        const WideNode& node = tree_.nodes[flight.next];
        const LocalRay& ray = flight.ray;
        Floats first(0.0F);
        Floats last(flight.best);
        for (int axis = 0; axis < 3; ++axis) {
            const Floats inverse(ray.inverse[axis]);
            first = max(mul_add(Floats::load(node.low[0] + ray.near_offset[axis]), inverse,
                                Floats(ray.near_add[axis])),
                        first);
            last = min(mul_add(Floats::load(node.low[0] + ray.far_offset[axis]), inverse,
                               Floats(ray.far_add[axis])),
                       last);
        }
        const Ints order = lanes_of(node.order[ray.signs]);
        const Floats entry = first.permuted(order);
        RayFlight::Level& level = flight.levels[flight.depth];
        entry.store(level.entry);
        level.child = node.child;
        level.order = node.order[ray.signs];
        level.waiting = (entry <= last.permuted(order)).bits();
        flight.depth += level.waiting != 0 ? 1 : 0;
        flight.take_next();
    }
    static HWY_INLINE Ints lanes_of(const std::uint32_t* order) {
        alignas(64) static constexpr std::int32_t kShift[kWideLanes] = {
            0, 0, 4, 4, 8, 8, 12, 12, 16, 16, 20, 20, 24, 24, 28, 28};
        return (Ints::pairs(order) >> Ints::load(kShift)) & Ints(15);
    }

    HWY_INLINE void test_leaf(RayFlight& flight) const {
        const std::uint32_t* const words =
            tree_.leaves.data() + (flight.next & ~WideOctree::kLeaf);
        WideLeafHead head;
        std::memcpy(&head, words, sizeof head);
        const Slot* const slots = words + kLeafHeadWords;
        const std::uint32_t copied = head.triangles + head.spheres;
        if (head.unit < flight.ray.least_unit) {
            add_open(flight, slots, copied + head.others);
            return;
        }
        const RayAtLeaf at(flight.ray, head, flight.next_entry);
        const std::uint32_t* const data = slots + copied + head.others;
        const auto* const spheres = reinterpret_cast<const float*>(data);
        const auto* const corners =
            reinterpret_cast<const std::uint16_t*>(data + std::size_t{4} * head.spheres);
        for (std::uint32_t i = 0; i < head.triangles; i += kWideLanes)
            take(flight, test_triangles(at, corners + i, head.triangles, rays_.bounds_scale()),
                 slots + i, head.triangles - i);
        for (std::uint32_t i = 0; i < head.spheres; i += kWideLanes)
            take(flight, test_spheres(at, spheres + i, head.spheres, rays_.bounds_scale()),
                 slots + head.triangles + i, head.spheres - i);
        if (head.others != 0) add_open(flight, slots + copied, head.others);
    }

    HWY_INLINE void take(RayFlight& flight, const LeafHits& hits, const Slot* slots,
                         std::uint32_t count) const {
        const std::uint32_t lanes = count < kWideLanes ? (1U << count) - 1 : 0xffffU;
        const Floats behind(flight.ray.behind);
        const RayMask nearer = hits.low <= Floats(flight.best);
        const RayMask ahead = hits.low > behind;
        const std::uint32_t sure = (hits.sure & nearer & ahead).bits() & lanes;
        const std::uint32_t open =
            (without(hits.open | hits.sure, hits.sure & ahead) & nearer & (hits.high >= behind))
                .bits() &
            lanes;
        if ((sure | open) != 0) keep(flight, hits, slots, sure, open);
    }

    HWY_NOINLINE void keep(RayFlight& flight, const LeafHits& hits, const Slot* slots,
                           std::uint32_t sure, std::uint32_t open) const {
        alignas(64) float low[kWideLanes];
        alignas(64) float high[kWideLanes];
        hits.low.store(low);
        hits.high.store(high);
        for (std::uint32_t lanes = sure | open; lanes != 0; lanes &= lanes - 1) {
            const int lane = std::countr_zero(lanes);
            const bool is_sure = (sure >> lane & 1) != 0;
            if (low[lane] > flight.best) continue;
            add(flight, {low[lane], high[lane], slots[lane], is_sure});
            if (is_sure) flight.best = std::min(flight.best, high[lane]);
        }
        std::uint32_t depth = 1;
        for (std::uint32_t i = 1; i < flight.depth; ++i) {
            RayFlight::Level& level = flight.levels[i];
            level.waiting &= (Floats::load(level.entry) <= Floats(flight.best)).bits();
            if (level.waiting == 0) continue;
            if (depth != i) flight.levels[depth] = level;
            ++depth;
        }
        flight.depth = depth;
    }

    HWY_NOINLINE void add_open(RayFlight& flight, const Slot* slots, std::uint32_t count) const {
        for (std::uint32_t i = 0; i < count; ++i)
            add(flight, {-kInfinity, kInfinity, slots[i], false});
    }

    void add(RayFlight& flight, const RayCandidate& candidate) const {
        if (flight.candidate_count == RayFlight::kMaxCandidates) {
            flight.drop_behind_best();
            if (flight.candidate_count > RayFlight::kMaxCandidates / 2) decide(flight);
        }
        flight.candidates[flight.candidate_count++] = candidate;
    }
    HWY_NOINLINE void decide(RayFlight& flight) const {
        const auto exact = rays_.decide(batch_[flight.index], flight.ray,
                                        {flight.candidates, flight.candidate_count});
        flight.candidate_count = 0;
        if (!exact) return;
        flight.candidates[flight.candidate_count++] = *exact;
        flight.best = std::min(flight.best, exact->high);
    }

    HWY_INLINE void land(RayFlight& flight) const {
        if (flight.candidate_count > 1) flight.drop_behind_best();
        if (flight.candidate_count == 0) {
            found_[flight.index] = kNoSlot;
            return;
        }
        bool alone = flight.candidates[0].sure;
        for (std::uint32_t i = 1; i < flight.candidate_count; ++i)
            alone &= flight.candidates[i].slot == flight.candidates[0].slot;
        if (!alone) decide(flight);
        found_[flight.index] = flight.candidate_count == 0 ? kNoSlot : flight.candidates[0].slot;
    }

    const SingleRays& rays_;
    const WideOctree& tree_;
    std::span<const Ray> batch_;
    Slot* found_;
    std::size_t next_ = 0;
    Queue at_nodes_;
    Queue at_leaves_;
    RayFlight flights_[kFlights];
};

void walk_rays(const SingleRays& rays, std::span<const Ray> batch, Slot* found) {
    const auto flights = std::make_unique<Flights>(rays, batch, found);
    flights->run();
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
      walk_(NUVO_FOR_ISA(resolved(isa), walk_rays)) {}

std::vector<RayAnswer> SingleRays::closest_hits(std::span<const Ray> rays) const {
    std::vector<RayAnswer> answers;
    answers.reserve(rays.size());
    constexpr std::size_t kBatch = 1024;
    std::array<Slot, kBatch> found;
    for (std::size_t first = 0; first < rays.size(); first += kBatch) {
        const auto batch = rays.subspan(first, std::min(kBatch, rays.size() - first));
        walk_(*this, batch, found.data());
        for (std::size_t i = 0; i < batch.size(); ++i) answers.push_back(answer(batch[i], found[i]));
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

Slot SingleRays::by_force(const Ray& ray) const {
    std::optional<Kernel::Hit> best;
    const ExactRay prepared = kernel_.prepare(ray);
    Slot nearest = kNoSlot;
    for (Slot slot = 0; slot < scene_.slot_end(); ++slot) {
        const auto hit = kernel_.hit_of(prepared, scene_.id(slot));
        if (!hit || (best && !kernel_.precedes(prepared, *hit, *best))) continue;
        best = hit;
        nearest = slot;
    }
    return nearest;
}

}  // namespace nuvo
#endif
