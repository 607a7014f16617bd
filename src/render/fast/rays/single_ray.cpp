#include "fast/rays/single_ray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/rays/single_ray.cpp"
#include <hwy/foreach_target.h>

#include "fast/rays/interleaved_rays.h"

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

void walk_rays(const SingleRays& rays, std::span<const Ray> all, RayAnswer* answers) {
    const auto interleaved = std::make_unique<InterleavedRays>(rays);
    std::array<Slot, kRayBatch> found;
    for (std::size_t first = 0; first < all.size(); first += kRayBatch) {
        const auto batch = all.subspan(first, std::min(kRayBatch, all.size() - first));
        interleaved->run(batch, found.data());
        rays.answer(batch, found.data(), answers + first);
    }
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"

namespace nuvo {

SingleRays::SingleRays(const FastScene& scene, InstructionSet isa, bool redo_exactly)
    : scene_(scene),
      kernel_(scene.scene(), scene.primitives(), std::nullopt, scene.back_faces()),
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

std::vector<RayAnswer> SingleRays::closest_hits(std::span<const Ray> rays,
                                                Progress* progress) const {
    constexpr std::size_t kTold = 64 * kRayBatch;
    std::vector<RayAnswer> answers(rays.size());
    begin(progress, "rays", rays.size());
    const std::size_t part = progress != nullptr ? kTold : rays.size();
    for (std::size_t first = 0; first < rays.size(); first += part) {
        const auto some = rays.subspan(first, std::min(part, rays.size() - first));
        walk_(*this, some, answers.data() + first);
        add(progress, some.size());
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
    const double slack = 4 * kFloatRoundoff * std::fabs(s) + 4 * local.error +
                         2 * root_tolerance() * (std::fabs(s) + local.advance) +
                         std::numeric_limits<float>::min();
    return RayCandidate{static_cast<float>(s - slack), static_cast<float>(s + slack), slot, true};
}

double SingleRays::root_of(const Ray& ray, Slot slot) const {
    return kernel_.hit_of(kernel_.prepare(ray), scene_.id(slot))->root.t;
}

void SingleRays::answer(std::span<const Ray> rays, const Slot* found, RayAnswer* answers) const {
    TriangleRoots roots{};
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

Slot SingleRays::brute_force(const Ray& ray) const {
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
