#include "paying_cut.h"

#include <algorithm>
#include <bit>

namespace nuvo {
namespace {

// Where a cut saves less than this share of a voxel's tests, another is tried. Commonly it is half.
constexpr double kLittle = 0.25;

// Sets of axes are bits, too.
constexpr unsigned kAllAxes = 7;
constexpr OctantMask kLowerHalf[3] = {0x55, 0x33, 0x0f};

// The mask where only `axes` are cut: the upper half of another axis falls to the lower.
OctantMask merged(OctantMask mask, unsigned axes) {
    for (int axis = 0; axis < 3; ++axis)
        if ((axes >> axis & 1) == 0)
            mask = static_cast<OctantMask>((mask | mask >> (1 << axis)) & kLowerHalf[axis]);
    return mask;
}

// How many items have each mask.
using Histogram = std::array<std::uint32_t, 256>;

OctantCounts counts_of(const Histogram& histogram, unsigned axes) {
    OctantCounts counts{};
    for (unsigned mask = 1; mask < histogram.size(); ++mask) {
        if (histogram[mask] == 0) continue;
        for (unsigned left = merged(static_cast<OctantMask>(mask), axes); left != 0;
             left &= left - 1)
            counts[static_cast<unsigned>(std::countr_zero(left))] += histogram[mask];
    }
    return counts;
}

Voxel cut_on(const Bounds3& box, const Point3& planes, unsigned axes) {
    Voxel cut{box, box.max};
    for (int axis = 0; axis < 3; ++axis)
        if ((axes >> axis & 1) != 0) cut.midpoint[axis] = planes[axis];
    return cut;
}

unsigned axes_that_may_be_cut(const Bounds3& box, const Point3& planes) {
    unsigned axes = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (!too_thin_to_cut(box, axis) && box.min[axis] < planes[axis] &&
            planes[axis] < box.max[axis])
            axes |= 1U << axis;
    return axes;
}

}  // namespace

std::size_t PayingCut::references() const {
    std::size_t sum = 0;
    for (const std::uint32_t count : counts) sum += count;
    return sum;
}

std::vector<ItemId> PayingCut::items(std::span<const ItemId> of_voxel, unsigned o) const {
    std::vector<ItemId> out;
    out.reserve(counts[o]);
    for (std::size_t i = 0; i < of_voxel.size(); ++i)
        if ((masks[i] >> o & 1) != 0) out.push_back(of_voxel[i]);
    return out;
}

CutFinder::CutFinder(std::span<const Bounds3> boxes, const BuildOptions& options)
    : options_(options) {
    const auto* prices = std::get_if<CalibratedCosts>(&options.worth);
    costs_ = prices ? prices->costs() : SahCosts{0, 0, 1};
    free_axes_ = prices && options.margin > 0;
    boxes_.reserve(boxes.size());
    for (const Bounds3& box : boxes) {
        boxes_.push_back(box.inflated(options.margin));
        root_ = root_.extended(boxes_.back());
    }
    if (root_.empty()) root_ = {{0, 0, 0}, {0, 0, 0}};
    const double widest = max_norm(root_.widths());
    if (widest > 0) unit_ = widest;
}

// No square leaves the range of double, however small or large the scene.
double CutFinder::area(const Bounds3& box) const {
    const Vector3 w = box.widths() / unit_;
    return 2 * (w.x * w.y + w.y * w.z + w.z * w.x);
}

std::optional<PayingCut> CutFinder::find(const Voxel& voxel, std::span<const ItemId> items) {
    const auto* rule = std::get_if<MaxObjects>(&options_.worth);
    if (rule && items.size() <= rule->count) return std::nullopt;
    const double tests = costs_.object * static_cast<double>(items.size());
    if (!(tests > costs_.leaf)) return std::nullopt;  // a cut would save less than it costs
    query_boxes_.clear();
    for (ItemId id : items) query_boxes_.push_back(boxes_[id]);
    const SplitQuery query{voxel, query_boxes_, options_.margin};
    std::optional<PayingCut> best;
    if (const std::optional<Point3> planes = options_.midpoint(query))
        best = cut_at(*planes, voxel, items);
    if (!options_.fallback || rule) return best;
    if (best && best->saved >= kLittle * area(voxel.bounds) * tests) return best;
    if (const std::optional<Point3> planes = options_.fallback(query)) {
        std::optional<PayingCut> other = cut_at(*planes, voxel, items);
        if (other && (!best || other->saved > best->saved)) return other;
    }
    return best;
}

std::optional<PayingCut> CutFinder::cut_at(const Point3& planes, const Voxel& voxel,
                                           std::span<const ItemId> items) const {
    const unsigned may_cut = axes_that_may_be_cut(voxel.bounds, planes);
    if (may_cut == 0) return std::nullopt;
    PayingCut cut{cut_on(voxel.bounds, planes, may_cut), {}, {}, 0};
    cut.masks.reserve(items.size());
    Histogram histogram{};
    for (ItemId id : items) {
        cut.masks.push_back(octants_of(id, cut.voxel));
        ++histogram[cut.masks.back()];
    }
    const double leaf =
        area(voxel.bounds) * (costs_.leaf + costs_.object * static_cast<double>(items.size()));
    if (!free_axes_) {
        cut.counts = counts_of(histogram, kAllAxes);
        cut.saved = leaf - cost_after(cut.voxel, cut.counts, kAllAxes);
        // Without a price, a cut that leaves every item in two or more octants gains nothing.
        const bool pays = std::holds_alternative<MaxObjects>(options_.worth)
                              ? std::count(cut.counts.begin(), cut.counts.end(), items.size()) < 2
                              : cut.saved > 0;
        if (!pays) return std::nullopt;
        return cut;
    }
    unsigned best = 0;
    for (unsigned axes = 1; axes <= kAllAxes; ++axes) {
        if ((axes & ~may_cut) != 0) continue;
        const OctantCounts counts = counts_of(histogram, axes);
        const double saved = leaf - cost_after(cut_on(voxel.bounds, planes, axes), counts, axes);
        if (!(saved > cut.saved)) continue;
        best = axes;
        cut.saved = saved;
        cut.counts = counts;
    }
    if (best == 0) return std::nullopt;
    cut.voxel = cut_on(voxel.bounds, planes, best);
    for (OctantMask& mask : cut.masks) mask = merged(mask, best);
    return cut;
}

// Of the sum of eq. 10. The far half of an axis that is not cut has no width and is never entered.
double CutFinder::cost_after(const Voxel& cut, const OctantCounts& counts, unsigned axes) const {
    double sum = costs_.interior * area(cut.bounds);
    for (unsigned o = 0; o < 8; ++o)
        if ((o & ~axes) == 0)
            sum += area(cut.octant(octant_digit(static_cast<int>(o)))) *
                   (costs_.leaf + costs_.object * counts[o]);
    return sum;
}

// An item that no plane meets lies where its box does; of others each octant is asked for.
OctantMask CutFinder::octants_of(ItemId item, const Voxel& cut) const {
    const Bounds3& box = boxes_[item];
    OctantMask mask = 0xff;
    for (int axis = 0; axis < 3; ++axis) {
        const double plane = cut.midpoint[axis];
        // The far half of an axis that is not cut: its neighbour lists all that is near it.
        const bool has_far_half = plane < cut.bounds.max[axis] || options_.margin == 0;
        if (!(box.min[axis] <= plane)) mask &= static_cast<OctantMask>(~kLowerHalf[axis]);
        if (!(has_far_half && box.max[axis] >= plane)) mask &= kLowerHalf[axis];
    }
    if (!options_.overlaps || std::has_single_bit(mask)) return mask;
    // The overlap test sees the octant grown by the margin; the boxes are grown already.
    OctantMask listed = 0;
    for (unsigned left = mask; left != 0; left &= left - 1) {
        const int o = std::countr_zero(left);
        if (options_.overlaps(item, cut.octant(octant_digit(o)).inflated(options_.margin)))
            listed |= static_cast<OctantMask>(1U << o);
    }
    return listed;
}

}  // namespace nuvo
