#include "fast/scene/local_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

// Floats are densest around 0. Where most of a scene is small things in one place of a wide hall
// that place is the frame's origin, so that they are told apart as if they stood alone.

namespace nuvo {
namespace {

constexpr std::size_t kSamples = 4096;
// A place holds at least this share of the samples,
constexpr std::size_t kCrowd = kSamples / 16;
// and is by this factor narrower than the scene: less is not worth the bit that a scene off 0
// loses.
constexpr double kFarNarrower = 64;
// Below this share of the scene surface points are hardly known. [numerics: stages]
constexpr double kLeastDense = 0x1p-40;

// Centres of items, evenly over the document.
std::vector<Point3> sample(const Primitives& primitives) {
    const std::size_t items = primitives.item_count();
    const std::size_t count = std::min(items, kSamples);
    std::vector<Point3> points(count);
    for (std::size_t i = 0; i < count; ++i)
        points[i] = primitives.item_boxes[i * items / count].center();
    return points;
}

// Halves the box on its widest axis, always to the fuller half, while that holds a crowd; stops
// where the box is a point.
Bounds3 densest(std::vector<Point3> points, Bounds3 box) {
    const std::size_t least = std::max<std::size_t>(1, points.size() * kCrowd / kSamples);
    while (true) {
        const Vec3<double> widths = box.max * 0.5 - box.min * 0.5;
        int axis = widths.x >= widths.y ? 0 : 1;
        if (widths.z > widths[axis]) axis = 2;
        const double middle = box.min[axis] + widths[axis];
        if (!(box.min[axis] < middle && middle < box.max[axis])) return box;
        const auto upper = std::partition(points.begin(), points.end(),
                                          [&](const Point3& p) { return p[axis] < middle; });
        const bool below = upper - points.begin() >= points.end() - upper;
        if (below)
            points.erase(upper, points.end());
        else
            points.erase(points.begin(), upper);
        if (points.size() < least) return box;
        (below ? box.max : box.min)[axis] = middle;
    }
}

}  // namespace

LocalFrame local_frame(const Primitives& primitives, const Bounds3& box) {
    if (box.empty()) return {};
    LocalFrame frame;
    frame.center = box.center();
    double half = max_norm(box.max * 0.5 - box.min * 0.5);
    double dense = half / 4;
    const Bounds3 crowd = densest(sample(primitives), box);
    const double crowd_half = max_norm(crowd.max * 0.5 - crowd.min * 0.5);
    if (crowd_half < half / kFarNarrower) {
        frame.center = crowd.center();
        dense = std::max(2 * crowd_half, half * kLeastDense);
        half = 2 * half;
    }
    int exponent = 0;
    std::frexp(half, &exponent);  // half < 2^exponent
    // A box thinner than 2^-1023 stays thinner than 1.
    if (half > 0)
        frame.scale =
            std::ldexp(1.0, std::min(-exponent, std::numeric_limits<double>::max_exponent - 1));
    frame.dense = dense * frame.scale;
    return frame;
}

}  // namespace nuvo
