#pragma once

#include <cstdint>
#include <span>

#include "exact_kernel.h"
#include "fast/scene/fast_scene.h"

namespace nuvo {

/// The closest hits of rays that are too few for a structure of their own: through the octree of
/// the pictures, in double; all that comes near is tested exactly. For one thread.
class FewRays {
  public:
    /// Keeps a reference to the scene, which is_ordinary().
    explicit FewRays(const FastScene& scene);

    /// What closest_hits() of the exact profile answers, until that has cost as much as to build a
    /// structure for rays; returns how many were answered.
    std::size_t closest_hits(std::span<const Ray> rays, RayAnswer* answers);

  private:
    using Kernel = ExactKernelOf<SceneStore>;

    RayAnswer closest_hit(const Ray& ray);

    const FastScene& scene_;
    Kernel kernel_;
    std::uint64_t spent_ = 0;  ///< about, in boxes of primitives
};

}  // namespace nuvo
