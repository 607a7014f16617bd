#include "compact_sweep.h"

#include "box_lanes.h"
#include "nuvo/math/error_bounds.h"

// The sweep of each axis: the cost of a plane at x is LSA(x) L(x) + RSA(x) R(x), with the areas of
// the two sides and the numbers of items that begin below and end above the plane [eq. 11, items on
// the plane counted on both sides]. L and R come from bins filled in one pass instead of sorted
// edges (Wald 2007). Between two edges the cost is linear in x: a bin's border therefore moves to
// either end of the gap between the last item that ends below it and the first that begins above,
// and a little into the gap, for an item that touched the plane would lie on both sides.
//
// The three axes are worked on at once.

namespace nuvo {
namespace {

// Of more items a sample of at least this size decides.
constexpr std::size_t kSample = 1024;
// How far into a gap the plane moves: 8 units in the last place of the largest local coordinates,
// or half the gap.
constexpr float kIntoGap = 0x1p-20F;

template <int kBins>
class Bins {
  public:
    explicit Bins(const Bounds3T<float>& voxel)
        : low_(four(voxel.min)),
          high_(four(voxel.max)),
          bins_per_width_(splat(kBins) / (high_ - low_)) {
        for (int i = 0; i < kBins; ++i) {
            begins_[i] = ends_[i] = FourInts{};
            first_begin_[i] = splat(kFloatInfinity);
            last_end_[i] = splat(-kFloatInfinity);
        }
    }

    void add(const Bounds3T<float>& box) {
        const BoxInFours b(box);
        const FourInts begin = bin(b.low);
        const FourInts end = bin(b.high);
        for (int axis = 0; axis < 3; ++axis) {
            ++begins_[begin[axis]][axis];
            ++ends_[end[axis]][axis];
            Four& first = first_begin_[begin[axis]];
            Four& last = last_end_[end[axis]];
            first[axis] = b.low[axis] < first[axis] ? b.low[axis] : first[axis];
            last[axis] = b.high[axis] > last[axis] ? b.high[axis] : last[axis];
        }
        ++count_;
    }

    Vec3<float> planes() const {
        // Of the bins from i on.
        Four right[kBins];
        Four first_begin[kBins];
        FourInts ends{};
        Four first = high_;
        for (int i = kBins - 1; i > 0; --i) {
            right[i] = __builtin_convertvector(ends += ends_[i], Four);
            first_begin[i] = first = least(first, first_begin_[i]);
        }
        const Four width = high_ - low_;
        const Four next = __builtin_shufflevector(width, width, 1, 2, 0, 3);
        const Four after = __builtin_shufflevector(width, width, 2, 0, 1, 3);
        const Four across = next * after;
        const Four around = next + after;
        Four best = splat(static_cast<float>(count_)) * (across + width * around);
        Four plane = high_;
        Four last = low_;
        FourInts begins{};
        for (int i = 1; i < kBins; ++i) {
            const Four left = __builtin_convertvector(begins += begins_[i - 1], Four);
            last = most(last, last_end_[i - 1]);
            const Four gap = first_begin[i] - last;
            const Four into = least(gap * 0.5F, splat(kIntoGap));
            for (const Four x : {last + into, first_begin[i] - into}) {
                const Four cost = (across + (x - low_) * around) * left +
                                  (across + (high_ - x) * around) * right[i];
                const FourInts better = (cost < best) & (x > low_) & (x < high_);
                best = better ? cost : best;
                plane = better ? x : plane;
            }
        }
        return {plane[0], plane[1], plane[2]};
    }

  private:
    // Of an axis without width any.
    FourInts bin(Four x) const {
        const Four place = (x - low_) * bins_per_width_;
        const Four at_least = place > 0.0F ? place : splat(0);
        return __builtin_convertvector(least(at_least, splat(kBins - 1)), FourInts);
    }

    Four low_;
    Four high_;
    Four bins_per_width_;
    std::size_t count_ = 0;
    FourInts begins_[kBins];   // items that begin in the bin
    FourInts ends_[kBins];     // items that end in it
    Four first_begin_[kBins];  // the least of their beginnings
    Four last_end_[kBins];     // the greatest of their ends
};

template <int kBins>
Vec3<float> planes_of_bins(const Bounds3T<float>& voxel, ItemSpan items, BoxSpan boxes) {
    Bins<kBins> bins(voxel);
    const std::size_t stride = items.size() / kSample + 1;
    const std::size_t ahead = kPrefetchAhead * stride;
    for (std::size_t i = 0; i < items.size(); i += stride) {
        if (i + ahead < items.size()) __builtin_prefetch(&boxes[items[i + ahead]]);
        bins.add(boxes[items[i]]);
    }
    return bins.planes();
}

}  // namespace

Vec3<float> sweep_planes(const Bounds3T<float>& voxel, ItemSpan items, BoxSpan boxes) {
    // Bins cost time of their own; for few items fewer find planes as good.
    if (items.size() < 64) return planes_of_bins<8>(voxel, items, boxes);
    if (items.size() < 256) return planes_of_bins<16>(voxel, items, boxes);
    return planes_of_bins<32>(voxel, items, boxes);
}

}  // namespace nuvo
