#include "nuvo/render/fast.h"

#include "fast/frame/count.h"
#include "fast/frame/frame.h"
#include "fast/rays/single_ray.h"
#include "fast/simd/dispatch.h"
#include "nuvo/math/big_vector.h"

namespace nuvo {
namespace {

FastOptions with_isa(FastOptions options) {
    options.isa = resolved(options.isa);
    return options;
}

}  // namespace

struct FastTracer::State {
    State(const Scene& scene, const Primitives& primitives, const FastOptions& given)
        : options(with_isa(given)),
          fast(scene, primitives, options.type, options.threads, options.back_faces,
               options.progress) {}

    BlockKeeper keeper;
    FastOptions options;
    FastScene fast;
    SerialTree serial{fast};
    KeptTables kept;
    std::size_t table_bytes = 0;
    std::size_t kept_bytes = 0;
    std::unique_ptr<SingleRays> single;  // made when rays are first asked for
};

FastTracer::FastTracer(const Scene& scene, const Primitives& primitives, const FastOptions& options)
    : state_(std::make_unique<State>(scene, primitives, options)) {}
FastTracer::~FastTracer() = default;
FastTracer::FastTracer(FastTracer&&) noexcept = default;
FastTracer& FastTracer::operator=(FastTracer&&) noexcept = default;

Image FastTracer::render(Resolution resolution, FastTimes* times) {
    const FastScene& fast = state_->fast;
    if (!Frame::can_show(fast)) {
        SerialTree& serial = state_->serial;
        Progress* const progress = state_->options.progress;
        return nuvo::render(fast.scene(), fast.primitives(), serial.octree(progress),
                            serial.profile(), resolution, progress);
    }
    Frame frame(state_->serial, state_->options, resolution, times, state_->kept);
    Image image = frame.render();
    state_->table_bytes = frame.memory_bytes();
    state_->kept_bytes = kept_block_bytes();
    return image;
}

std::vector<RayAnswer> FastTracer::closest_hits(std::span<const Ray> rays) {
    if (!state_->fast.is_ordinary())
        return state_->serial.closest_hits(rays, state_->options.progress);
    std::unique_ptr<SingleRays>& single = state_->single;
    if (!single)
        single = std::make_unique<SingleRays>(state_->fast, state_->options.isa,
                                              state_->options.redo_exactly);
    return single->closest_hits(rays, state_->options.progress, &state_->serial);
}

RayCounts FastTracer::count_rays(Resolution resolution) const {
    const FastScene& fast = state_->fast;
    if (Frame::can_show(fast))
        return nuvo::count_rays(fast, state_->options.isa, resolution, state_->options.progress);
    SerialTree& serial = state_->serial;
    const TraceCounts counts = count_events(fast.scene(), fast.primitives(), serial.octree(),
                                            serial.profile(), resolution, state_->options.progress);
    return {counts.primary_rays, counts.shadow_rays};
}

OctreeType FastTracer::octree_type() const {
    return octree().rule == CutRule::kSpatial ? OctreeType::kUniform : OctreeType::kNonuniform;
}

const CompactOctree& FastTracer::octree() const { return state_->fast.octree(); }

FastMemory FastTracer::memory() const {
    const std::size_t rays = state_->single ? state_->single->memory_bytes() : 0;
    return {state_->fast.octree().memory_bytes() + rays, state_->table_bytes,
            state_->fast.memory_bytes(), state_->kept_bytes + state_->kept.thread_bytes()};
}

}  // namespace nuvo
