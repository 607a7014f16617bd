#include "nuvo/render/planes.h"

#include <type_traits>

#include "chosen.h"
#include "nuvo/math/error_bounds.h"
#include "tracer.h"

namespace nuvo {
namespace {

// Stages that tests had to go to so far; those of plain kernels know one only.
template <typename Kernel>
PredicateCounts stages_of(const Kernel& kernel) {
    if constexpr (requires { kernel.stage_counts(); })
        return {0, kernel.stage_counts().wider, kernel.stage_counts().exact};
    return {};
}

Stage last_stage(const PredicateCounts& before, const PredicateCounts& after) {
    if (after.exact > before.exact) return Stage::kExact;
    return after.wider > before.wider ? Stage::kWider : Stage::kCheap;
}

// Calls `use(kernel, search, counts)` with a search that counts.
template <typename Use>
TraceCounts counted(const Scene& scene, const Primitives& primitives, const Octree* octree,
                    const Profile& profile, Use&& use) {
    TraceCounts counts;
    std::uint64_t tested = 0;
    with_kernel(scene, primitives, profile, [&](const auto& kernel) {
        const EventCounter counter{&counts, &tested};
        const auto run = [&](auto search) {
            Tracer tracer(scene, kernel, std::move(search));
            use(kernel, tracer, counts);
            counts.primary_rays = tracer.primary_rays();
            counts.shadow_rays = tracer.shadow_rays();
        };
        if (octree) {
            with_search(kernel, primitives, *octree, profile, counter, run);
        } else {
            run(BruteForceSearch(kernel, primitives, counter));
        }
        if constexpr (requires { kernel.stage_counts(); }) {
            counts.predicates = stages_of(kernel);
            counts.predicates->tests = tested;
        }
    });
    return counts;
}

// Writes the nearest hit down as the last pixel's.
template <typename Kernel>
struct HitWriter {
    const Scene& scene;
    const Kernel& kernel;
    PixelPlanes& planes;

    template <typename Hit>
    void hit(const Hit& hit) {
        const PrimitiveSource& source = kernel.source(hit.primitive);
        planes.t.back() = static_cast<double>(kernel.t(hit));
        planes.shape.back() = static_cast<std::int32_t>(scene.objects[source.object].shape_index);
        planes.triangle.back() = static_cast<std::int32_t>(source.triangle);
    }
    template <typename Surface>
    void asks(const Surface&, std::size_t) {}
    void lit(std::size_t) {}
};

}  // namespace

TraceCounts count_events(const Scene& scene, const Primitives& primitives, const Octree& octree,
                         const Profile& profile, Resolution resolution, Progress* progress) {
    return counted(
        scene, primitives, &octree, profile,
        [&](const auto&, auto& tracer, const TraceCounts&) { tracer.image(resolution, progress); });
}

PixelPlanes record_planes(const Scene& scene, const Primitives& primitives, const Octree* octree,
                          const Profile& profile, Resolution resolution, Progress* progress) {
    PixelPlanes planes;
    const auto record = [&](const auto& kernel, auto& tracer, const TraceCounts& counts) {
        const RayGenerator rays(scene.camera, resolution);
        const std::size_t pixels = pixel_count(resolution);
        begin(progress, "pixels", pixels);
        planes.tests.reserve(pixels);
        planes.searches.reserve(pixels);
        planes.t.reserve(pixels);
        planes.shape.reserve(pixels);
        planes.triangle.reserve(pixels);
        planes.stage.reserve(pixels);
        for (int y = 0; y < resolution.height; ++y) {
            for (int x = 0; x < resolution.width; ++x) {
                const TraceCounts before = counts;
                const PredicateCounts stages = stages_of(kernel);
                planes.t.push_back(kInfinity);
                planes.shape.push_back(-1);
                planes.triangle.push_back(-1);
                tracer.color(rays.ray(x, y),
                             HitWriter<std::decay_t<decltype(kernel)>>{scene, kernel, planes});
                planes.tests.push_back(static_cast<std::uint32_t>(counts.intersection_tests -
                                                                  before.intersection_tests));
                planes.searches.push_back(
                    static_cast<std::uint32_t>(counts.voxel_searches - before.voxel_searches));
                planes.stage.push_back(last_stage(stages, stages_of(kernel)));
            }
            add(progress, static_cast<std::uint64_t>(resolution.width));
        }
    };
    planes.counts = counted(scene, primitives, octree, profile, record);
    return planes;
}

}  // namespace nuvo
