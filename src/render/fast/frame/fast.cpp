#include "nuvo/render/fast.h"

#include <algorithm>

#include "fast/frame/count.h"
#include "fast/frame/frame.h"
#include "fast/frame/serial_pixels.h"
#include "fast/primary/macro_tile.h"
#include "fast/rays/few_rays.h"
#include "fast/rays/single_ray.h"
#include "fast/simd/dispatch.h"
#include "nuvo/math/big_vector.h"
#include "nuvo/math/parallel.h"

namespace nuvo {
namespace {

FastOptions with_isa(FastOptions options) {
    options.isa = resolved(options.isa);
    return options;
}

// Where floats tell nothing of the camera's rays.
Image serial_picture(SerialTree& serial, const FastOptions& options, Resolution size) {
    serial.octree(options.progress);
    const RayGenerator rays(serial.scene().scene().camera, size);
    const std::vector<TilePlace> tiles = macro_tiles(size);
    std::vector<std::unique_ptr<SerialPixels>> pixels(static_cast<std::size_t>(options.threads));
    Image image = Image::unset(size.width, size.height);
    begin(options.progress, "macro tiles", tiles.size());
    for_each_index(options.threads, tiles.size(), [&](std::size_t i, int thread) {
        std::unique_ptr<SerialPixels>& own = pixels[static_cast<std::size_t>(thread)];
        if (!own) own = std::make_unique<SerialPixels>(serial);
        own->draw(rays, tiles[i].x, tiles[i].y, kMacroSide, image);
        add(options.progress, 1);
    });
    return image;
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
    if (!Frame::can_show(fast, resolution))
        return serial_picture(state_->serial, state_->options, resolution);
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
    if (!single) single = std::make_unique<SingleRays>(state_->fast, state_->options.isa);
    return single->closest_hits(rays, state_->options.progress, &state_->serial);
}

std::vector<RayAnswer> FastTracer::closest_hits_once(std::span<const Ray> rays) {
    if (state_->single || !state_->fast.is_ordinary()) return closest_hits(rays);
    std::vector<RayAnswer> answers(rays.size());
    const std::size_t answered = FewRays(state_->fast).closest_hits(rays, answers.data());
    if (answered == rays.size()) return answers;
    const std::vector<RayAnswer> rest = closest_hits(rays.subspan(answered));
    std::copy(rest.begin(), rest.end(), answers.begin() + static_cast<std::ptrdiff_t>(answered));
    return answers;
}

RayCounts FastTracer::count_rays(Resolution resolution) const {
    const FastScene& fast = state_->fast;
    if (Frame::can_show(fast, resolution))
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
