// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_WIDE_TRIANGLES_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_WIDE_TRIANGLES_H_
#undef NUVO_RENDER_FAST_WIDE_TRIANGLES_H_
#else
#define NUVO_RENDER_FAST_WIDE_TRIANGLES_H_
#endif

#include <cstddef>

#include "fast/shading/shading_tables.h"
#include "fast/simd/wide_vectors.h"

// The functions of smooth triangles, 8 at a time.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// Triangles in the local frame.
struct WideTriangles {
    Wide3 a;     ///< from the anchor of CameraRays to corner a
    Wide3 from;  ///< from the eye to it; in a parallel projection the view's direction
    Wide3 e1;    ///< a to b
    Wide3 e2;    ///< a to c
};

/// The coordinate at which the point is seen, an integer; at most the picture's size.
HWY_INLINE Wide pixel_of(const Wide3& point, const Vector3& axis, const Wide& depth, int size) {
    const Wide limit(size);
    const Wide seen = dot(point, Wide3::all(axis)) / (depth * Wide(nuvo::dot(axis, axis)));
    return floor(min(max(seen, -limit), limit));
}

/// The numbers of SmoothTriangle of 8 triangles, in its order, with the normals n0, n1, n2 at the
/// corners; `sign` is -1 where the denominator S is negative or the normal turns, 1 where not or
/// both, NaN where unknown. With S = d.(e2 x e1), V = d.(from x e2), W = d.(e1 x from) as in
/// surface_point(), the normal is along n0 S + (n1 - n0) V + (n2 - n0) W. In a parallel projection
/// S is constant, V and W are the functions of those planes through a. Below 2^-49 of its
/// magnitudes a triple product is noise. `longest` bounds |d|.
HWY_INLINE void smooth_functions(const CameraRays& camera, double longest, const WideTriangles& t,
                                 const Wide3& n0, const Wide3& n1, const Wide3& n2,
                                 const Wide& sign, float (&out)[SmoothTriangle::kNumbers][kBatch]) {
    constexpr double kSmallest = 0x1p-1000;  // products that matter beside it have not underflown
    const Wide largest = max(max_norm(n0), max(max_norm(n1), max_norm(n2)));
    const Wide3 s = cross(t.e2, t.e1);
    const Wide3 v = cross(t.from, t.e2);
    const Wide3 w = cross(t.e1, t.from);
    const auto sum = [&](const Wide& of_s, const Wide& of_v, const Wide& of_w)
                         HWY_ATTR { return n0 * of_s + (n1 - n0) * of_v + (n2 - n0) * of_w; };
    const auto along = [&](const Vector3& axis) HWY_ATTR {
        const Wide3 d = Wide3::all(axis);
        return sum(camera.parallel ? Wide(0.0) : dot(s, d), dot(v, d), dot(w, d));
    };
    const auto size_of = [](const Wide3& u) HWY_ATTR { return sqrt(dot(u, u)); };
    const Wide3 right = along(camera.right);
    const Wide3 down = along(camera.down);
    // Near the centroid: precision is best there.
    const Wide3 forward = Wide3::all(camera.forward);
    const Wide3 center = t.a + (t.e1 + t.e2) * Wide(1.0 / 3);
    const Wide depth = camera.parallel ? Wide(1.0) : dot(center, forward);
    const Wide x = pixel_of(center, camera.right, depth, camera.resolution.width);
    const Wide y = pixel_of(center, camera.down, depth, camera.resolution.height);
    const Wide3 constant =
        camera.parallel ? sum(dot(s, forward), -dot(v, t.a), -dot(w, t.a)) : along(camera.forward);
    const Wide3 at = constant + right * x + down * y;
    const Wide scale = sign / max_norm(at);
    const Wide edges = norm1(t.e1) + norm1(t.e2);
    const Wide noise = (norm1(t.a) + edges + Wide(CameraExtent(camera).starts)) * edges * largest *
                           Wide(8 * 0x1p-49 * longest) +
                       Wide(kSmallest);
    // Of each sum in float: the coefficients' rounding, and 3 of the two operations.
    const Wide rounding = abs(scale) * Wide(static_cast<double>(roundings(4)));
    store_rounded(at * scale, out);
    store_rounded(right * scale, out + 3);
    store_rounded(down * scale, out + 6);
    store_rounded(x, out[9]);
    store_rounded(y, out[10]);
    store_rounded(mul_add(rounding, size_of(at), abs(scale) * noise), out[11]);
    store_rounded(rounding * size_of(right), out[12]);
    store_rounded(rounding * size_of(down), out[13]);
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_WIDE_TRIANGLES_H_
