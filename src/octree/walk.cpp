#include "nuvo/octree/walk.h"

namespace nuvo {

double path_error_bound(const Bounds3& root) {
    constexpr double kRoundoff = std::numeric_limits<double>::epsilon() / 2;
    const double size = std::fmax(max_norm(root.min), max_norm(root.max));
    return 16 * kRoundoff * size;
}

}  // namespace nuvo
