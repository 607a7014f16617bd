#include "nuvo/render/fast.h"

// Stands in for the fast tracer's single rays where they are not built yet: no answers.

namespace nuvo {

std::vector<RayAnswer> FastTracer::closest_hits(std::span<const Ray> rays) const {
    return std::vector<RayAnswer>(rays.size());
}

}  // namespace nuvo
