#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "nuvo/image/image.h"
#include "nuvo/math/progress.h"
#include "nuvo/math/ray.h"
#include "nuvo/octree/compact.h"
#include "nuvo/render/primitives.h"
#include "nuvo/render/profile.h"
#include "nuvo/render/render.h"
#include "nuvo/scene/scene.h"

namespace nuvo {

/// Vector instruction sets of x86; every one gives the same bytes.
enum class InstructionSet : std::uint8_t { kBest, kAvx512, kAvx2, kSse4, kSse2 };

/// Those that this machine has, the best first; never kBest.
std::vector<InstructionSet> supported_instruction_sets();

struct FastOptions {
    /// None: uniform, unless that lists a primitive much more often than a non-uniform octree does,
    /// as measured on a part of the scene.
    std::optional<OctreeType> type;
    int threads = 1;  ///< >= 1; the picture does not depend on it
    InstructionSet isa = InstructionSet::kBest;
    /// False: what the float stages of pictures leave open is decided by their rounded values. For
    /// measuring what exactness costs; pictures may then differ from the exact profile's.
    bool redo_exactly = true;
    BackFaces back_faces = BackFaces::kSolid;
    Progress* progress = nullptr;  ///< of whatever the tracer is doing; outlives it
};

/// Bytes held by a FastTracer.
struct FastMemory {
    std::size_t structure = 0;  ///< nodes, references and leaf copies
    std::size_t tables = 0;     ///< per camera and light, of the last picture
    std::size_t corners = 0;    ///< of triangles in single precision, and the primitives' order
    /// Between pictures: freed blocks that wait for their next use, and what threads know of pairs
    /// of triangles and of exact signs.
    std::size_t kept = 0;
};

/// Time by stage on the clock of the wall, in seconds, summed over the threads.
struct FastTimes {
    double tables = 0;
    double primary = 0;
    double shadow = 0;
    double shading = 0;
};

/// Rays of one picture as the exact profile traces them.
struct RayCounts {
    std::uint64_t primary_rays = 0;
    std::uint64_t shadow_rays = 0;
};

/// Renders what the exact profile renders, to the byte, by coherent groups of rays in vector
/// registers. Keeps references to scene and primitives (leaf items: single primitives).
class FastTracer {
  public:
    /// Builds the octree.
    FastTracer(const Scene& scene, const Primitives& primitives, const FastOptions& options);
    ~FastTracer();
    FastTracer(FastTracer&&) noexcept;
    FastTracer& operator=(FastTracer&&) noexcept;

    /// Adds to `times` if it is given, at a small cost. Between two pictures the scene's camera and
    /// lights may change, nothing else.
    Image render(Resolution resolution, FastTimes* times = nullptr);
    /// The closest hit of each ray, as closest_hits() answers it. Keeps tables for the next calls.
    std::vector<RayAnswer> closest_hits(std::span<const Ray> rays);
    /// The same of rays after which no others come: for few no tables are made.
    std::vector<RayAnswer> closest_hits_once(std::span<const Ray> rays);

    /// Counted in a run of its own, by the exact profile's decisions, so that it does not depend on
    /// what the float stages leave open.
    RayCounts count_rays(Resolution resolution) const;

    FastMemory memory() const;
    /// The one in use.
    OctreeType octree_type() const;
    const CompactOctree& octree() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace nuvo
