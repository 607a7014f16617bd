#include "nuvo/octree/walk.h"

#include "nuvo/math/error_bounds.h"

namespace nuvo {

double path_error_bound(const Bounds3& root) {
    const double size = std::fmax(max_norm(root.min), max_norm(root.max));
    return 16 * kUnitRoundoff * size;
}

}  // namespace nuvo
