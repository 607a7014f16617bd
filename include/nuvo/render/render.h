#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "nuvo/image/image.h"
#include "nuvo/math/progress.h"
#include "nuvo/math/ray.h"
#include "nuvo/octree/octree.h"
#include "nuvo/render/primitives.h"
#include "nuvo/render/profile.h"
#include "nuvo/scene/scene.h"

namespace nuvo {

/// How often each stage of the exact predicates decided, over one picture.
struct PredicateCounts {
    std::uint64_t tests = 0;  ///< one primitive against one ray; most end in the cheap stage
    std::uint64_t wider = 0;  ///< times that the cheap stage left it to tighter bounds in double
    std::uint64_t exact = 0;  ///< times that exact arithmetic decided, orders of hits included
};

/// Events of one picture as the thesis counts them. [thesis 5.7]
struct TraceCounts {
    std::uint64_t primary_rays = 0;
    std::uint64_t shadow_rays = 0;
    std::uint64_t intersection_tests = 0;  ///< one ray against one leaf item (a mesh counts once)
    std::uint64_t voxel_searches = 0;      ///< calls that look for the next leaf on a ray's way
    std::optional<PredicateCounts> predicates = {};  ///< of Precision::kExact only
};

/// What decided a pixel's color.
struct PixelFacts {
    std::optional<PrimitiveId> primitive;  ///< the nearest; none: the background
    /// The lights that reach the hit point unblocked: bit i for light i; lights from the 64th on
    /// each change all bits, so that different sets still differ all but surely.
    std::uint64_t lit = 0;
};

/// How one ray of a query ended: `object` and `triangle` are those of the file, see docs.
struct RayAnswer {
    bool hit = false;
    std::int64_t shape = -1;
    std::int64_t triangle = -1;
    double t = 0;  ///< in units of the ray's direction; infinity for a miss
};

/// Builds the octree that `profile` asks for over the leaf items. Deterministic.
Octree build_tree(const Scene& scene, const Primitives& primitives, const Profile& profile,
                  Progress* progress = nullptr);

/// Bytes of the copies of the primitives that the next functions make for as long as they run.
std::size_t tracer_bytes(const Scene& scene, const Primitives& primitives, const Profile& profile);

/// Renders through the octree, serially. [thesis 4.1, 4.3]
Image render(const Scene& scene, const Primitives& primitives, const Octree& octree,
             const Profile& profile, Resolution resolution, Progress* progress = nullptr);
/// The same picture with every item tested against every ray.
Image render_brute_force(const Scene& scene, const Primitives& primitives, const Profile& profile,
                         Resolution resolution, Progress* progress = nullptr);
/// The facts behind render()'s picture, by rows from the top.
std::vector<PixelFacts> render_facts(const Scene& scene, const Primitives& primitives,
                                     const Octree& octree, const Profile& profile,
                                     Resolution resolution, Progress* progress = nullptr);
/// Counts the events of render() in a run of its own, so that timed runs carry no counters.
TraceCounts count_events(const Scene& scene, const Primitives& primitives, const Octree& octree,
                         const Profile& profile, Resolution resolution,
                         Progress* progress = nullptr);

/// The closest hit of each ray; `octree` null means brute force.
std::vector<RayAnswer> closest_hits(const Scene& scene, const Primitives& primitives,
                                    const Octree* octree, const Profile& profile,
                                    std::span<const Ray> rays, Progress* progress = nullptr);

}  // namespace nuvo
