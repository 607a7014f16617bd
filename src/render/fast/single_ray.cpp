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
#include "fast/ray_block.h"
#include "fast/single_ray_leaf.h"

// A node's boxes are met from near to far, as in Embree's single-ray kernels (Wald et al. 2014),
// but 16 at a step. What floats leave open is kept as a candidate with an interval, and decided by
// exact arithmetic at the end, if nothing that is surely nearer has come up.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class Flights {
  public:
    static constexpr std::uint32_t kFlights = 32;

    Flights(const SingleRays& rays, std::span<const Ray> batch, Slot* found)
        : rays_(rays), tree_(rays.tree()), batch_(batch), found_(found) {}

    void run() {
        for (RayFlight& flight : flights_) depart(flight);
        while (at_nodes_.count + at_leaves_.count > 0) {
            // A few steps at a leaf or at a landing, with some left, would hardly overlap.
            do {
                step_all();
            } while (at_nodes_.count >= kFlights / 2);
            for (std::size_t count = at_leaves_.restart(), i = 0; i < count; ++i) {
                RayFlight& flight = *at_leaves_.flight[i];
                test_leaf(flight);
                flight.take_next();
                queue(flight);
            }
            for (std::size_t count = landed_.restart(), i = 0; i < count; ++i) {
                RayFlight& flight = *landed_.flight[i];
                land(flight);
                depart(flight);
            }
        }
    }

  private:
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();

    // The flights in one state. Read from the front while it is filled anew.
    struct Queue {
        std::size_t count = 0;
        RayFlight* flight[kFlights + 1];
        HWY_INLINE std::size_t restart() { return std::exchange(count, std::size_t{0}); }
        HWY_INLINE void add(RayFlight& one, std::size_t once_or_not) {
            flight[count] = &one;
            count += once_or_not;
        }
    };

    HWY_NOINLINE void step_all() {
        for (std::size_t count = at_nodes_.restart(), i = 0; i < count; ++i) {
            RayFlight& flight = *at_nodes_.flight[i];
            step(flight);
            queue(flight);
        }
    }

    // By arithmetic: branches here would be coin tosses.
    HWY_INLINE void queue(RayFlight& flight) {
        static_assert(WideOctree::kLeaf == 1U << 31 && RayFlight::kLanded == 1U << 30);
        const std::size_t next = flight.next;
        const std::size_t leaf = next >> 31;
        const std::size_t landed = next >> 30 & ~(leaf << 1 | leaf);
        at_leaves_.add(flight, leaf);
        landed_.add(flight, landed);
        at_nodes_.add(flight, 1 - leaf - landed);
        if (!prefetches_) return;
        const auto at_leaf = reinterpret_cast<std::uintptr_t>(tree_.leaves.data()) +
                             (next & ~std::size_t{WideOctree::kLeaf}) * sizeof(std::uint32_t);
        const auto at_node = reinterpret_cast<std::uintptr_t>(tree_.nodes.data()) +
                             (next & ~std::size_t{RayFlight::kLanded}) * sizeof(WideNode);
        const std::uintptr_t place = ((at_leaf ^ at_node) & -leaf) ^ at_node;
        constexpr std::size_t kLine = 64;
        for (std::size_t at = 0; at < sizeof(WideNode); at += kLine)
            __builtin_prefetch(reinterpret_cast<const char*>(place + at));
    }

    // Lets the next ray of the batch take the place, if there is one.
    HWY_INLINE void depart(RayFlight& flight) {
        while (next_ < batch_.size()) {
            const std::size_t index = next_++;
            RayBlock& block = blocks_[index / RayBlock::kRays];
            const std::size_t lane = index % RayBlock::kRays;
            if (lane == 0) block.prepare(batch_.subspan(index), rays_.scene().frame(), tree_.reach);
            if ((block.valid >> lane & 1) != 0) {
                flight.start(index);
                at_nodes_.add(flight, 1);
                return;
            }
            found_[index] = rays_.by_force(batch_[index]);
        }
    }

    // One node: what the ray meets of it waits on a level of its own.
    HWY_INLINE void step(RayFlight& flight) const {
        const WideNode& node = tree_.nodes[flight.next];
        const RayBlock& ray = blocks_[flight.index / RayBlock::kRays];
        const std::size_t lane = flight.index % RayBlock::kRays;
        const auto signs = static_cast<std::uint32_t>(ray.signs[lane]);
        const FacesOnWay& faces = kFacesBySigns[signs];
        Floats first(0.0F);
        Floats last(flight.best);
        for (int axis = 0; axis < 3; ++axis) {
            const Floats inverse(ray.inverse[axis][lane]);
            first = max(mul_add(Floats::load(node.low[0] + faces.near[axis]), inverse,
                                Floats(ray.near_add[axis][lane])),
                        first);
            last = min(mul_add(Floats::load(node.low[0] + faces.far[axis]), inverse,
                               Floats(ray.far_add[axis][lane])),
                       last);
        }
        const Ints order = lanes_of(node.order[signs]);
        const Floats entry = first.permuted(order);
        RayFlight::Level& level = *flight.top;
        entry.store(level.entry);
        Ints::load(reinterpret_cast<const std::int32_t*>(node.child))
            .permuted(order)
            .store(reinterpret_cast<std::int32_t*>(level.child));
        const std::uint32_t met = (entry <= last.permuted(order)).bits();
        level.waiting = met;
        flight.top += static_cast<std::ptrdiff_t>(met != 0);
        flight.take_next();
    }
    static HWY_INLINE Ints lanes_of(const std::uint32_t* order) {
        alignas(64) static constexpr std::int32_t kShift[kWideLanes] = {
            0, 0, 4, 4, 8, 8, 12, 12, 16, 16, 20, 20, 24, 24, 28, 28};
        return Ints::pairs(order) >> Ints::load(kShift);
    }

    HWY_INLINE void test_leaf(RayFlight& flight) const {
        const std::uint32_t* const words = tree_.leaves.data() + (flight.next & ~WideOctree::kLeaf);
        WideLeafHead head;
        std::memcpy(&head, words, sizeof head);
        const Slot* const slots = words + kLeafHeadWords;
        const std::uint32_t copied = head.triangles + head.spheres;
        const RayBlock& ray = blocks_[flight.index / RayBlock::kRays];
        const std::size_t lane = flight.index % RayBlock::kRays;
        if (head.unit < ray.least_unit[lane]) {
            add_open(flight, slots, copied + head.others);
            return;
        }
        const RayAtLeaf at(ray, lane, head, flight.next_entry);
        const std::uint32_t* const data = slots + copied + head.others;
        const auto* const spheres = reinterpret_cast<const float*>(data);
        const auto* const corners =
            reinterpret_cast<const std::uint16_t*>(data + std::size_t{4} * head.spheres);
        for (std::uint32_t i = 0; i < head.triangles; i += kWideLanes)
            take(flight, test_triangles(at, corners + i, head.triangles, rays_.bounds_scale()),
                 ray.behind[lane], slots + i, head.triangles - i);
        for (std::uint32_t i = 0; i < head.spheres; i += kWideLanes)
            take(flight,
                 test_spheres(at, ray, lane, spheres + i, head.spheres, head.spheres - i,
                              rays_.bounds_scale()),
                 ray.behind[lane], slots + head.triangles + i, head.spheres - i);
        if (head.others != 0) add_open(flight, slots + copied, head.others);
    }

    HWY_INLINE void take(RayFlight& flight, const LeafHits& hits, float origin, const Slot* slots,
                         std::uint32_t count) const {
        const std::uint32_t lanes = count < kWideLanes ? (1U << count) - 1 : 0xffffU;
        const Floats behind(origin);
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
        RayFlight::Level* free = flight.levels + 1;
        for (RayFlight::Level* level = free; level != flight.top; ++level) {
            level->waiting &= (Floats::load(level->entry) <= Floats(flight.best)).bits();
            if (level->waiting == 0) continue;
            if (level != free) *free = *level;
            ++free;
        }
        flight.top = free;
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
        const Ray& ray = batch_[flight.index];
        const LocalRay local(ray, rays_.scene().frame(), tree_.reach);
        const auto exact = rays_.decide(ray, local, {flight.candidates, flight.candidate_count});
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
    // Asking for a voxel's memory when it is chosen pays only where the caches cannot hold them
    // all.
    static constexpr std::size_t kCached = 1 << 20;
    const bool prefetches_ = tree_.memory_bytes() > kCached;
    std::size_t next_ = 0;
    Queue at_nodes_;
    Queue at_leaves_;
    Queue landed_;
    RayFlight flights_[kFlights];
    RayBlock blocks_[kRayBatch / RayBlock::kRays];
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
      roots_(resolved(isa)),
      bounds_scale_(redo_exactly ? 1.0F : 0.0F),
      walk_(NUVO_FOR_ISA(resolved(isa), walk_rays)) {
    for (const Object& object : scene.scene().objects) {
        const auto* const mesh = std::get_if<TriangleMesh>(&object.shape);
        meshes_.push_back({mesh ? mesh->positions.data() : nullptr,
                           mesh ? mesh->triangles.data() : nullptr, object.shape_index});
    }
}

std::vector<RayAnswer> SingleRays::closest_hits(std::span<const Ray> rays) const {
    std::vector<RayAnswer> answers(rays.size());
    std::array<Slot, kRayBatch> found;
    for (std::size_t first = 0; first < rays.size(); first += kRayBatch) {
        const auto batch = rays.subspan(first, std::min(kRayBatch, rays.size() - first));
        walk_(*this, batch, found.data());
        answer(batch, found.data(), answers.data() + first);
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

double SingleRays::root_of(const Ray& ray, Slot slot) const {
    return kernel_.hit_of(kernel_.prepare(ray), scene_.id(slot))->root.t;
}

void SingleRays::answer(std::span<const Ray> rays, const Slot* found, RayAnswer* answers) const {
    TriangleRoots roots;
    std::array<std::size_t, TriangleRoots::kCount> ray_of;
    std::size_t count = 0;
    const auto finish = [&] {
        roots_.find(roots, count);
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t ray = ray_of[i];
            const bool known = (roots.found >> i & 1) != 0;
            answers[ray].t = known ? roots.t[i] : root_of(rays[ray], found[ray]);
        }
        count = 0;
    };
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (found[i] == kNoSlot) {
            answers[i].t = std::numeric_limits<double>::infinity();
            continue;
        }
        const PrimitiveSource& source = scene_.source(found[i]);
        const MeshPlace& mesh = meshes_[source.object];
        answers[i] = {true, mesh.shape, source.triangle, 0};
        if (found[i] >= scene_.triangle_end()) {
            answers[i].t = root_of(rays[i], found[i]);
            continue;
        }
        const IndexTriple& corners = mesh.triangles[source.triangle];
        ray_of[count] = i;
        roots.set(count++, rays[i], mesh.positions[corners[0]], mesh.positions[corners[1]],
                  mesh.positions[corners[2]]);
        if (count == TriangleRoots::kCount) finish();
    }
    finish();
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
