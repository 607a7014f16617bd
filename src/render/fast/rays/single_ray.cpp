#include "fast/rays/single_ray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "fast/tile/nearest_hit.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/rays/single_ray.cpp"
#include <hwy/foreach_target.h>

#include "fast/rays/interleaved_rays.h"

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

std::size_t walk_rays(SingleRays& rays, std::span<const Ray> all, bool may_give_up,
                      RayAnswer* answers) {
    const auto interleaved = std::make_unique<InterleavedRays>(rays);
    std::array<Slot, kRayBatch> found;
    std::size_t first = 0;
    while (first < all.size() && !(may_give_up && rays.gives_up(first))) {
        const auto batch = all.subspan(first, std::min(kRayBatch, all.size() - first));
        interleaved->run(batch, found.data());
        rays.answer(batch, found.data(), answers + first);
        first += batch.size();
    }
    return first;
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"
#include "nuvo/math/error_bounds.h"

namespace nuvo {
namespace {

// A candidate of the exact fallback costs so many tests.
constexpr std::uint64_t kTestsOfCandidate = 4;

}  // namespace

SingleRays::SingleRays(const FastScene& scene, InstructionSet isa)
    : scene_(scene),
      kernel_(scene.scene(), scene.primitives(), std::nullopt, scene.back_faces()),
      tree_(scene),
      roots_(resolved(isa)),
      walk_(NUVO_FOR_ISA(resolved(isa), walk_rays)) {
    for (const Object& object : scene.scene().objects) {
        const auto* const mesh = std::get_if<TriangleMesh>(&object.shape);
        meshes_.push_back({mesh ? mesh->positions.data() : nullptr,
                           mesh ? mesh->triangles.data() : nullptr, object.shape_index,
                           scene.front_only(object)});
    }
}

std::vector<RayAnswer> SingleRays::closest_hits(std::span<const Ray> rays, Progress* progress,
                                                SerialTree* serial) {
    constexpr std::size_t kTold = 64 * kRayBatch;
    std::vector<RayAnswer> answers(rays.size());
    begin(progress, "rays", rays.size());
    const std::size_t part = progress != nullptr ? kTold : rays.size();
    for (std::size_t first = 0; first < rays.size();) {
        const auto some = rays.subspan(first, std::min(part, rays.size() - first));
        const std::size_t answered = walk_(*this, some, serial != nullptr, answers.data() + first);
        first += answered;
        rays_ += answered;
        add(progress, answered);
        if (answered == some.size()) continue;
        const auto rest = serial->closest_hits(rays.subspan(first), progress);
        std::copy(rest.begin(), rest.end(), answers.begin() + static_cast<std::ptrdiff_t>(first));
        break;
    }
    return answers;
}

std::optional<RayCandidate> SingleRays::decide(const Ray& ray, const RayLanes& lanes,
                                               std::size_t lane,
                                               std::span<const RayCandidate> candidates) {
    tests_ += kTestsOfCandidate * candidates.size();
    std::array<Slot, RayState::kMaxCandidates> slots;
    std::size_t count = 0;
    for (const RayCandidate& candidate : candidates) slots[count++] = candidate.slot;
    std::sort(slots.begin(), slots.begin() + count);
    count =
        static_cast<std::size_t>(std::unique(slots.begin(), slots.begin() + count) - slots.begin());
    const auto hit = nearest_of(ray, {slots.data(), count});
    if (!hit) return std::nullopt;
    // Rounded to float, with the advance's and the origin's errors: |d| >= 1.
    const double advance = lanes.advance[lane];
    const double s = hit->t * lanes.scale[lane] - advance;
    const double slack = roundings(4) * std::fabs(s) + 4.0 * lanes.error(lane) +
                         2 * root_tolerance() * (std::fabs(s) + advance) +
                         std::numeric_limits<float>::min();
    return RayCandidate{static_cast<float>(s - slack), static_cast<float>(s + slack), hit->slot,
                        true};
}

std::optional<SingleRays::Nearest> SingleRays::nearest_of(const Ray& ray, std::span<Slot> slots) {
    static_assert(RayState::kMaxCandidates <= PairRoots::kCount);
    const auto triangles = static_cast<std::size_t>(
        std::lower_bound(slots.begin(), slots.end(), scene_.triangle_end()) - slots.begin());
    PairRoots roots;
    for (std::size_t i = 0; i < triangles; ++i)
        set_triangle(roots, i, ray, scene_.source(slots[i]));
    roots_.find_triangles(roots, triangles);
    double end = kInfinity;
    for (std::size_t i = 0; i < triangles; ++i)
        if ((roots.hit >> i & 1) != 0) end = std::min(end, roots.t[i] * (1 + root_tolerance()));
    std::size_t left = 0;
    std::optional<Nearest> sure;
    for (std::size_t i = 0; i < slots.size(); ++i) {
        const bool hit = i < triangles && (roots.hit >> i & 1) != 0;
        if (hit && roots.t[i] * (1 - root_tolerance()) > end) continue;
        if (i < triangles && (roots.missed >> i & 1) != 0) continue;
        // Of those in one plane, met at the same t, the earliest slot comes first.
        if (hit && sure && coplanar(sure->slot, slots[i])) continue;
        if (hit) sure = Nearest{slots[i], roots.t[i]};
        slots[left++] = slots[i];
    }
    if (left == 0 || (left == 1 && sure)) return sure;
    return exactly_nearest_of(ray, slots.first(left));
}

bool SingleRays::coplanar(Slot first, Slot second) {
    return coplanar_.of({first, second}, [&] {
        return nuvo::coplanar(scene_.triangle(first), scene_.triangle(second), counts_);
    });
}

std::optional<SingleRays::Nearest> SingleRays::exactly_nearest_of(
    const Ray& ray, std::span<const Slot> slots) const {
    NearestHit nearest(scene_, kernel_, ray);
    for (const Slot slot : slots) nearest.test(slot);
    if (!nearest.best()) return std::nullopt;
    return Nearest{nearest.slot(), nearest.best()->root.t};
}

double SingleRays::root_of(const Ray& ray, Slot slot) const {
    return kernel_.hit_of(kernel_.prepare(ray), scene_.id(slot))->root.t;
}

inline void SingleRays::set_triangle(PairRoots& roots, std::size_t i, const Ray& ray,
                                     const PrimitiveSource& source) const {
    const MeshPlace& mesh = meshes_[source.object];
    const IndexTriple& corners = mesh.triangles[source.triangle];
    roots.set(i, ray, mesh.positions[corners[0]], mesh.positions[corners[1]],
              mesh.positions[corners[2]]);
    roots.set_front_only(i, mesh.front_only);
}

namespace {

// Rays whose roots are still to be found.
struct Pending {
    PairRoots roots;
    std::array<std::size_t, PairRoots::kCount> ray;
    std::size_t count = 0;
};

}  // namespace

// Each step asks for memory by what the one before has fetched: for all rays a step before the
// next.
inline void SingleRays::prefetch(std::span<const Slot> found) const {
    std::array<const PrimitiveSource*, kRayBatch> sources;
    std::size_t triangles = 0;
    std::size_t others = kRayBatch;  // from the end
    for (const Slot slot : found) {
        if (slot == kNoSlot) continue;
        const PrimitiveSource* const source = &scene_.source(slot);
        __builtin_prefetch(source);
        sources[slot < scene_.triangle_end() ? triangles++ : --others] = source;
    }
    const std::span of_triangles(sources.data(), triangles);
    for (const PrimitiveSource* source : std::span(sources).subspan(others))
        prefetch_object(object_of(*source));
    if (meshes_.size() * sizeof(MeshPlace) > kCached)
        for (const PrimitiveSource* source : of_triangles)
            __builtin_prefetch(&meshes_[source->object]);
    for (const PrimitiveSource* source : of_triangles)
        __builtin_prefetch(meshes_[source->object].triangles + source->triangle);
    for (const PrimitiveSource* source : of_triangles) {
        const MeshPlace& mesh = meshes_[source->object];
        for (const auto corner : mesh.triangles[source->triangle])
            __builtin_prefetch(mesh.positions + corner);
    }
}

void SingleRays::answer(std::span<const Ray> rays, const Slot* found, RayAnswer* answers) const {
    if (tree_.memory_bytes() > kCached) prefetch({found, rays.size()});
    Pending triangles;
    Pending spheres;
    triangles.roots.only_roots = true;
    const auto finish = [&](Pending& some, auto find) {
        (roots_.*find)(some.roots, some.count);
        for (std::size_t i = 0; i < some.count; ++i) {
            const std::size_t ray = some.ray[i];
            const bool known = (some.roots.found >> i & 1) != 0;
            answers[ray].t = known ? some.roots.t[i] : root_of(rays[ray], found[ray]);
        }
        some.count = 0;
    };
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (found[i] == kNoSlot) {
            answers[i].t = kInfinity;
            continue;
        }
        const PrimitiveSource& source = scene_.source(found[i]);
        if (found[i] < scene_.triangle_end()) {
            answers[i] = {true, meshes_[source.object].shape, source.triangle, 0};
            triangles.ray[triangles.count] = i;
            set_triangle(triangles.roots, triangles.count++, rays[i], source);
            if (triangles.count == PairRoots::kCount)
                finish(triangles, &PairRootStage::find_triangles);
            continue;
        }
        const Object& object = object_of(source);
        answers[i] = {true, object.shape_index, source.triangle, 0};
        if (found[i] >= scene_.sphere_end()) {
            answers[i].t = root_of(rays[i], found[i]);
            continue;
        }
        spheres.ray[spheres.count] = i;
        spheres.roots.set(spheres.count, rays[i], std::get<Sphere>(object.shape));
        spheres.roots.set_front_only(spheres.count++, scene_.front_only(object));
        if (spheres.count == PairRoots::kCount) finish(spheres, &PairRootStage::find_spheres);
    }
    finish(triangles, &PairRootStage::find_triangles);
    finish(spheres, &PairRootStage::find_spheres);
}

Slot SingleRays::brute_force(const Ray& ray) {
    NearestHit nearest(scene_, kernel_, ray);
    if (!nearest.may_meet_any()) return kNoSlot;
    for (Slot slot = 0; slot < scene_.slot_end(); ++slot)
        tests_ += 1 + (nearest.test(slot) ? kTestsOfCandidate : 0);
    return nearest.slot();
}

}  // namespace nuvo
#endif
