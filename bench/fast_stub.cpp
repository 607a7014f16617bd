#include "nuvo/render/fast.h"

// Stands in for the fast tracer where it is not built yet: the exact renderer behind its face.

namespace nuvo {

struct FastTracer::State {
    const Scene& scene;
    const Primitives& primitives;
    Profile profile;
    Octree octree;
};

FastTracer::FastTracer(const Scene& scene, const Primitives& primitives,
                       const FastOptions& options) {
    Profile profile = exact_profile();
    profile.type = options.type;
    profile.midpoint = MidpointChoice::kSweep;
    profile.walk = WalkChoice::kDescent;
    state_ = std::make_unique<State>(
        State{scene, primitives, profile, build_tree(scene, primitives, profile)});
}
FastTracer::~FastTracer() = default;
FastTracer::FastTracer(FastTracer&&) noexcept = default;
FastTracer& FastTracer::operator=(FastTracer&&) noexcept = default;

Image FastTracer::render(Resolution resolution, FastTimes*) {
    return nuvo::render(state_->scene, state_->primitives, state_->octree, state_->profile,
                        resolution);
}

std::vector<RayAnswer> FastTracer::closest_hits(std::span<const Ray> rays) const {
    return nuvo::closest_hits(state_->scene, state_->primitives, &state_->octree, state_->profile,
                              rays);
}

FastMemory FastTracer::memory() const { return {state_->octree.nodes().size() * sizeof(Node), 0}; }

}  // namespace nuvo
