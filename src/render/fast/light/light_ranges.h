// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_LIGHT_RANGES_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_LIGHT_RANGES_H_
#undef NUVO_RENDER_FAST_LIGHT_RANGES_H_
#else
#define NUVO_RENDER_FAST_LIGHT_RANGES_H_
#endif

#include <algorithm>
#include <cmath>

#include "fast/light/light_items.h"
#include "fast/light/light_map.h"
#include "fast/light/light_point.h"
#include "fast/scene/local_corners.h"
#include "fast/simd/lanes.h"
#include "nuvo/math/error_bounds.h"

// Where 16 items at a time may be met by shadow rays, rounded outwards.
//
// A shadow ray from a true point P* through a point Q of an item meets the light's plane or face
// where Q does, and Q lies less deep. What is looked up is P, which is off by some error at most;
// so an item's range is widened by how far that, the item's own roundings and those of the map can
// move u and v.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// The corners of 16 triangles, or the least and the greatest corner of 16 boxes.
struct ItemCorners {
    int count;        ///< 3 or 2
    Floats at[3][3];  ///< by corner, axis

    /// Their largest coordinates.
    HWY_INLINE Floats size() const {
        Floats most(0.0F);
        for (int corner = 0; corner < count; ++corner)
            for (const Floats& x : at[corner]) most = max(most, abs(x));
        return most;
    }
};

/// A bound that grows with an item's coordinates: a + b size.
struct SizedError {
    float a = 0;
    float b = 0;
    HWY_INLINE Floats of(const Floats& size) const {
        return mul_add(size, Floats(b), Floats(a)) * Floats(1 + roundings(4));
    }
};

/// What is met of 16 items, by lane.
struct LightRanges {
    std::uint32_t lanes;  ///< those that are met at all
    Floats low[2];        ///< of u and v
    Floats high[2];
    Floats near;  ///< depth
};

// A corner, or a sphere's centre, radius and their sum, in units of the largest.
constexpr double kItemRounding = roundings(4);

/// Through the plane of a light outside of the scene. [light_map.h]
class PlaneRanges {
  public:
    /// Fills in `out`'s axis, sign, place and size; false where the light is not far outside.
    bool start(const LightPoint& light, const FastScene& scene, LightMap& out, float (&extent)[2]) {
        int k = 0;
        for (int axis = 1; axis < 3; ++axis)
            if (std::fabs(light.toward[axis]) > std::fabs(light.toward[k])) k = axis;
        axis_ = k;
        for (int axis = 0; axis < 3; ++axis) toward_[axis] = static_cast<float>(light.toward[axis]);
        weight_ = static_cast<float>(light.weight);
        const double reach = scene.reach();
        const double toward = std::fabs(light.toward[k]);
        const double least = toward - light.weight * reach;  // of |W_k|
        if (!(least > kLeastShare * toward)) return false;
        double other = 0;
        for (int axis = 0; axis < 3; ++axis)
            if (axis != k) other = std::fmax(other, std::fabs(light.toward[axis]));
        // u = P_u - P_k s, s = W_u / W_k. By a change e of P on each axis s changes by at most
        // e weight (1 + |s|) / least, u by e (1 + |s|) and P_k times that. W has two roundings of
        // numbers up to 2, which u takes P_k times; s, the product and the difference three more.
        const double slope = (other + light.weight * reach) / least;
        const double rounding = roundings(4) / least + roundings(4);
        stretch_ = 2 * (1 + slope) * (1 + reach * light.weight / least);
        rounding_ = (1 + slope) * rounding;
        out.inside = false;
        out.stretch = static_cast<float>(stretch_);
        out.axis = k;
        out.sign = light.toward[k] > 0 ? 1.0F : -1.0F;
        depth_sign_ = -out.sign;
        see(scene.octree().bounds, light, out, extent);
        return true;
    }

    HWY_INLINE LightRanges of(const ItemCorners& c) const {
        LightRanges out;
        out.lanes = 0xffff;
        const Floats size = c.size();
        const Floats margin = margin_.of(size);
        for (int i = 0; i < 2; ++i) {
            const int axis = (axis_ + 1 + i) % 3;
            const Floats first = meets(c.at[0][axis], c.at[0][axis_], axis);
            const Floats second = meets(c.at[1][axis], c.at[1][axis_], axis);
            Floats low = min(first, second);
            Floats high = max(first, second);
            const auto add = [&](const Floats& u) HWY_ATTR {
                low = min(low, u);
                high = max(high, u);
            };
            // The map is projective: the images of corners bound the item's.
            if (c.count == 3) {
                add(meets(c.at[2][axis], c.at[2][axis_], axis));
            } else {
                add(meets(c.at[0][axis], c.at[1][axis_], axis));
                add(meets(c.at[1][axis], c.at[0][axis_], axis));
            }
            out.low[i] = low - margin;
            out.high[i] = high + margin;
        }
        Floats near =
            min(c.at[0][axis_] * Floats(depth_sign_), c.at[1][axis_] * Floats(depth_sign_));
        if (c.count == 3) near = min(near, c.at[2][axis_] * Floats(depth_sign_));
        out.near = near - depth_margin_.of(size);
        return out;
    }

    /// `error` bounds that of points of at most `point_size` on each axis, and how far what may
    /// block a shadow ray lies from it.
    void allow(double error, double point_size) {
        margin_ = {rounded_up(stretch_ * error + rounding_ * point_size),
                   rounded_up(stretch_ * kItemRounding + rounding_)};
        depth_margin_ = {rounded_up(2 * error), rounded_up(2 * kItemRounding)};
    }

  private:
    // Seen from nearer, the scene's near side would fill most of the plane.
    static constexpr double kLeastShare = 0.25;
    static constexpr float kLeastExtent = 0x1p-20F;

    HWY_INLINE Floats meets(const Floats& p, const Floats& deep, int axis) const {
        const Floats w = neg_mul_add(p, Floats(weight_), Floats(toward_[axis]));
        const Floats wk = neg_mul_add(deep, Floats(weight_), Floats(toward_[axis_]));
        return neg_mul_add(deep, w / wk, p);
    }
    // The part of the plane through which the scene is seen: what lies beyond counts as its border.
    void see(const Bounds3T<float>& box, const LightPoint& light, LightMap& out,
             float (&extent)[2]) const {
        for (int i = 0; i < 2; ++i) {
            const int axis = (axis_ + 1 + i) % 3;
            double low = kInfinity;
            double high = -kInfinity;
            for (const double deep : {box.min[axis_], box.max[axis_]})
                for (const double p : {box.min[axis], box.max[axis]}) {
                    const double w = light.toward[axis] - light.weight * p;
                    const double wk = light.toward[axis_] - light.weight * deep;
                    low = std::fmin(low, p - deep * (w / wk));
                    high = std::fmax(high, p - deep * (w / wk));
                }
            out.low[i] = static_cast<float>(low);
            extent[i] = std::fmax(static_cast<float>(high - low), kLeastExtent);
        }
    }

    int axis_ = 0;
    float toward_[3] = {};
    float weight_ = 0;
    float depth_sign_ = 0;
    double stretch_ = 0;
    double rounding_ = 0;  // of u and v in units of a coordinate
    SizedError margin_;    // of u and v
    SizedError depth_margin_;
};

/// Through the six faces of a cube around a light among the items. [light_map.h]
class CubeRanges {
  public:
    void start(const LightPoint& light, LightMap& out, float (&extent)[2]) {
        for (int axis = 0; axis < 3; ++axis) toward_[axis] = static_cast<float>(light.toward[axis]);
        weight_ = static_cast<float>(light.weight);
        out.inside = true;
        out.stretch = 4 * weight_;
        for (int i = 0; i < 2; ++i) {
            out.low[i] = -1;
            extent[i] = 2;
        }
    }

    /// `error` as in PlaneRanges.
    void allow(double error, LightMap& out) {
        const double size = out.point_size;
        double toward = 0;
        for (const float x : toward_) toward = std::fmax(toward, std::fabs(x));
        // W = L - P has three roundings of these, the point's as well as the item's.
        error_by_size_ = {
            rounded_up(weight_ * error + roundings(4) * (2 * toward + weight_ * size)),
            rounded_up(weight_ * (kItemRounding + roundings(4)))};
        out.nearest = rounded_up(
            2 * kNear *
            (static_cast<double>(error_by_size_.a) + static_cast<double>(error_by_size_.b) * size));
    }

    /// The items that the next calls of of() are about.
    HWY_INLINE void take(const ItemCorners& c) {
        count_ = c.count;
        error_ = error_by_size_.of(c.size());
        for (int axis = 0; axis < 3; ++axis) {
            for (int i = 0; i < c.count; ++i)
                toward_light_[axis][i] =
                    neg_mul_add(c.at[i][axis], Floats(weight_), Floats(toward_[axis]));
            low_[axis] = min(toward_light_[axis][0], toward_light_[axis][1]);
            high_[axis] = max(toward_light_[axis][0], toward_light_[axis][1]);
            if (c.count == 3) {
                low_[axis] = min(low_[axis], toward_light_[axis][2]);
                high_[axis] = max(high_[axis], toward_light_[axis][2]);
            }
        }
    }
    /// Face 2 k (+ 1): the one on which W_k is the largest (the least) component.
    HWY_INLINE LightRanges of(int face) const {
        const int k = face / 2;
        const bool upper = face % 2 == 0;
        const Floats least = upper ? low_[k] : -high_[k];
        const Floats most = upper ? high_[k] : -low_[k];
        // u(Q) is within 1 + 4 error / W_k of the point's, that within 1.
        const Floats limit = mul_add(error_, Floats(4.0F), most);
        RayMask met = limit > Floats(0.0F);
        const int axes[2] = {(k + 1) % 3, (k + 2) % 3};
        for (const int axis : axes) met = met & (low_[axis] <= limit) & (high_[axis] >= -limit);
        LightRanges out;
        out.lanes = met.bits();
        if (out.lanes == 0) return out;
        // By a change e of W on each axis u changes by at most 2 e / (W_k - e), for |u| <= 1, and
        // W_k >= least; as much again for what |u| may be above.
        const RayMask deep = least > error_ * Floats(kNear);
        const Floats inverse_least = Floats(1.0F) / least;
        const Floats margin = mul_add(error_ * Floats(8.0F), inverse_least, Floats(roundings(8)));
        for (int i = 0; i < 2; ++i) {
            const auto [low, high] = range(axes[i], k, upper, inverse_least, most);
            out.low[i] = select(deep, low - margin, Floats(-2.0F));
            out.high[i] = select(deep, high + margin, Floats(2.0F));
        }
        out.near = neg_mul_add(error_, Floats(2.0F), max(least, Floats(0.0F)));
        return out;
    }

  private:
    // What lies less deep than this many errors may be met anywhere on a face.
    static constexpr float kNear = 16;

    struct Range {
        Floats low;
        Floats high;
    };
    HWY_INLINE Range range(int axis, int k, bool upper, const Floats& inverse_least,
                           const Floats& most) const {
        if (count_ == 2) {
            const Floats inverse_most = Floats(1.0F) / most;
            return {min(low_[axis] * inverse_least, low_[axis] * inverse_most),
                    max(high_[axis] * inverse_least, high_[axis] * inverse_most)};
        }
        const Floats sign(upper ? 1.0F : -1.0F);
        const Floats u[3] = {toward_light_[axis][0] / (toward_light_[k][0] * sign),
                             toward_light_[axis][1] / (toward_light_[k][1] * sign),
                             toward_light_[axis][2] / (toward_light_[k][2] * sign)};
        return {min(u[0], min(u[1], u[2])), max(u[0], max(u[1], u[2]))};
    }

    float toward_[3] = {};
    float weight_ = 0;
    SizedError error_by_size_;  // of W
    int count_ = 0;
    Floats error_;
    Floats toward_light_[3][3];  // by axis, corner
    Floats low_[3];
    Floats high_[3];
};

/// Through whichever the light has.
class ItemRanges {
  public:
    /// Fills in `out`, and how far u and v go; false where nothing can be looked up.
    bool start(const LightPoint& light, const FastScene& scene, LightMap& out, float (&extent)[2]) {
        if (!light.finite || !(scene.reach() < kMostReach) || scene.slot_end() == 0) return false;
        if (!plane_.start(light, scene, out, extent)) cube_.start(light, out, extent);
        inside_ = out.inside;
        // Of a wide scene the dense place and what is about it.
        constexpr double kAbout = 16;
        out.point_size = rounded_up(std::fmin(scene.reach(), kAbout * scene.frame().dense));
        return true;
    }
    /// Points may be off by `error` on each axis; what lies within `touch` of a shadow ray counts
    /// as met.
    void allow(double error, double touch, LightMap& out) {
        out.point_error = static_cast<float>(error);
        if (inside_)
            cube_.allow(error + touch, out);
        else
            plane_.allow(error + touch, out.point_size);
    }

    /// Calls use(face, ranges, lanes) for the faces on which those of `there` are met.
    template <typename Use>
    HWY_INLINE void for_each_face(const ItemCorners& items, std::uint32_t there, Use&& use) {
        if (!inside_) {
            use(0, plane_.of(items), there);
            return;
        }
        cube_.take(items);
        for (int face = 0; face < 6; ++face) {
            const LightRanges ranges = cube_.of(face);
            if ((ranges.lanes & there) != 0) use(face, ranges, ranges.lanes & there);
        }
    }

  private:
    static constexpr double kMostReach = 1.5;

    PlaneRanges plane_;
    CubeRanges cube_;
    bool inside_ = false;
};

/// Asks for what corners_of() reads of an item.
HWY_INLINE void prefetch_corners(const LightItems& items, Slot slot) {
    const Slot triangle_end = items.scene.triangle_end();
    if (slot < triangle_end)
        prefetch_corners(items.scene.triangles()[slot]);
    else
        __builtin_prefetch(&items.quadrics[slot - triangle_end]);
}

/// The corners of `count` items of one kind, at most 16, whose slots are slot_at(0) and on; the
/// last one's again beyond.
// No item is met outside of the octree's box, which alone is known to lie on one side of the
// light's plane; the sphere around an ellipsoid may reach out of it. [numerics: light buffers]
template <typename SlotAt>
HWY_INLINE ItemCorners corners_of(const LightItems& items, Slot count, const SlotAt& slot_at) {
    const Bounds3T<float>& box = items.scene.octree().bounds;
    const Slot triangle_end = items.scene.triangle_end();
    ItemCorners out;
    out.count = slot_at(0) < triangle_end ? 3 : 2;
    if (out.count == 3) {
        load_corners(
            [&](std::size_t i) -> const LocalTriangle& {
                return items.scene.triangles()[slot_at(std::min(static_cast<Slot>(i), count - 1))];
            },
            out.at);
        return out;
    }
    alignas(64) float at[2][3][16];
    for (Slot i = 0; i < 16; ++i) {
        const LocalSphere& shape = items.quadrics[slot_at(std::min(i, count - 1)) - triangle_end];
        for (int axis = 0; axis < 3; ++axis) {
            // Of a radius that is NaN the box is left.
            const float low = shape.center[axis] - shape.radius;
            const float high = shape.center[axis] + shape.radius;
            at[0][axis][i] = low > box.min[axis] ? low : box.min[axis];
            at[1][axis][i] = high < box.max[axis] ? high : box.max[axis];
        }
    }
    for (int corner = 0; corner < 2; ++corner)
        for (int axis = 0; axis < 3; ++axis) out.at[corner][axis] = Floats::load(at[corner][axis]);
    return out;
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_LIGHT_RANGES_H_
