#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exact_kernel.h"
#include "fast/rays/pair_roots.h"
#include "fast/rays/ray_state.h"
#include "fast/rays/wide_bvh.h"
#include "fast/tile/pair_cache.h"
#include "fast/tile/serial_tree.h"
#include "nuvo/render/fast.h"

// Incoherent rays, each on its own: a step decides on 16 voxels or 8 to 16 primitives at once
// (interleaved_rays.h), floats with proven bounds leave almost nothing open, and what they do leave
// goes to the predicates of the serial tracer.

namespace nuvo {

/// So many rays are walked before their answers are made.
inline constexpr std::size_t kRayBatch = 1024;

/// The closest hits of arbitrary rays. Not for several threads at once.
class SingleRays {
    using Kernel = ExactKernelOf<SceneStore>;

  public:
    /// Keeps a reference to the scene, which is_ordinary(); makes copies of its own in a layout for
    /// rays.
    SingleRays(const FastScene& scene, InstructionSet isa);

    /// What closest_hits() of the exact profile answers. Where floats leave most to exact tests the
    /// rest is left to the serial tracer, if there is one.
    std::vector<RayAnswer> closest_hits(std::span<const Ray> rays, Progress* progress = nullptr,
                                        SerialTree* serial = nullptr);

    /// Asking for memory ahead pays where the second cache cannot hold the scene, and costs little
    /// where it can. With nodes and leaves below this the first one nearly does.
    static constexpr std::size_t kCached = 1 << 17;
    /// Bytes of nodes and leaves.
    std::size_t memory_bytes() const { return tree_.memory_bytes(); }

    // For the walks.
    const FastScene& scene() const { return scene_; }
    const WideBvh& tree() const { return tree_; }
    /// After `rays` of this call.
    bool gives_up(std::size_t rays) const { return tests_ > serial_cost(rays_ + rays, scene_); }
    /// The nearest of the candidates by exact arithmetic, if any is met. The ray is the lane-th
    /// one of `lanes`.
    std::optional<RayCandidate> decide(const Ray& ray, const RayLanes& lanes, std::size_t lane,
                                       std::span<const RayCandidate> candidates);
    /// The nearest primitive among all; kNoSlot: none.
    Slot brute_force(const Ray& ray);
    /// The answers to rays of which found[i] is known to be what ray i meets first.
    void answer(std::span<const Ray> rays, const Slot* found, RayAnswer* answers) const;

  private:
    // Where the triangles of an object are. Of an object without any nothing is asked.
    struct MeshPlace {
        const Point3* positions;
        const IndexTriple* triangles;
        std::int64_t shape;
        bool front_only;
    };
    struct Nearest {
        Slot slot;
        double t;  // Root::t
    };

    double root_of(const Ray& ray, Slot slot) const;
    /// The nearest of different slots, which ascend; changes them. By vectors of doubles where
    /// these are sure.
    std::optional<Nearest> nearest_of(const Ray& ray, std::span<Slot> slots);
    std::optional<Nearest> exactly_nearest_of(const Ray& ray, std::span<const Slot> slots) const;
    /// Whether both triangles lie in one plane.
    bool coplanar(Slot first, Slot second);
    // As a function of its own g++ takes it for one without effects, and leaves it out.
    [[gnu::always_inline]] void prefetch(std::span<const Slot> found) const;
    void set_triangle(PairRoots& roots, std::size_t i, const Ray& ray,
                      const PrimitiveSource& source) const;
    const Object& object_of(const PrimitiveSource& source) const {
        return scene_.scene().objects[source.object];
    }

    const FastScene& scene_;
    Kernel kernel_;
    WideBvh tree_;
    std::vector<MeshPlace> meshes_;  // by object
    PairRootStage roots_;
    std::size_t (*walk_)(SingleRays&, std::span<const Ray>, bool, RayAnswer*);
    PairCache<bool> coplanar_;
    StageCounts counts_;       // of coplanar()
    std::uint64_t rays_ = 0;   // answered
    std::uint64_t tests_ = 0;  // exact ones
};

}  // namespace nuvo
