#include "trial_cut.h"

namespace nuvo {
namespace {

// The far half of an axis that was not cut: its neighbour lists all that is near it.
bool empty_slab(const Bounds3& box) {
    return box.min.x == box.max.x || box.min.y == box.max.y || box.min.z == box.max.z;
}

// Strictly beyond the planes of the octant that meet in the midpoint.
bool reaches(const Bounds3& box, const Point3& midpoint, int digit) {
    const int bits = octant_bits(digit);
    for (int axis = 0; axis < 3; ++axis) {
        const bool upper = (bits >> axis & 1) != 0;
        if (!(upper ? box.max[axis] > midpoint[axis] : box.min[axis] < midpoint[axis]))
            return false;
    }
    return true;
}

}  // namespace

std::size_t TrialCut::references() const {
    std::size_t sum = 0;
    for (const Items& octant : octants) sum += octant.size();
    return sum;
}

Cutter::Cutter(std::span<const Bounds3> boxes, const BuildOptions& options) : options_(options) {
    boxes_.reserve(boxes.size());
    for (const Bounds3& box : boxes) boxes_.push_back(box.inflated(options.margin));
}

Bounds3 Cutter::root() const {
    Bounds3 root;
    for (const Bounds3& box : boxes_) root = root.extended(box);
    return root.empty() ? Bounds3{{0, 0, 0}, {0, 0, 0}} : root;
}

std::optional<TrialCut> Cutter::cut(const Voxel& voxel, const Items& items) {
    const std::optional<Point3> midpoint = choose_midpoint(voxel, items);
    if (!midpoint) return std::nullopt;
    TrialCut trial{{voxel.bounds, *midpoint}, {}};
    for (int digit = 1; digit <= 8; ++digit)
        distribute(trial.voxel, digit, items, trial.octants[static_cast<std::size_t>(digit - 1)]);
    return trial;
}

std::optional<Point3> Cutter::choose_midpoint(const Voxel& voxel, const Items& items) {
    query_boxes_.clear();
    for (ItemId id : items) query_boxes_.push_back(boxes_[id]);
    std::optional<Point3> midpoint = options_.midpoint({voxel, query_boxes_, options_.margin});
    if (!midpoint) return midpoint;
    int cut_axes = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (too_thin_to_cut(voxel.bounds, axis))
            (*midpoint)[axis] = voxel.bounds.max[axis];
        else
            ++cut_axes;
    }
    if (cut_axes == 0) return std::nullopt;
    return midpoint;
}

void Cutter::distribute(const Voxel& voxel, int digit, const Items& items, Items& out) const {
    const Bounds3 octant = voxel.octant(digit);
    if (options_.margin > 0 && empty_slab(octant)) return;
    // The overlap test sees the voxel grown by the margin; the boxes are grown already.
    const Bounds3 grown = octant.inflated(options_.margin);
    for (ItemId id : items)
        if ((options_.strict_placement ? reaches(boxes_[id], voxel.midpoint, digit)
                                       : boxes_[id].overlaps(octant)) &&
            (!options_.overlaps || options_.overlaps(id, grown)))
            out.push_back(id);
}

}  // namespace nuvo
