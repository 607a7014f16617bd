#pragma once

#include "fast/camera/exact_planes.h"
#include "fast/scene/fast_scene.h"
#include "fast/tile/pair_cache.h"

// Which of two triangles is nearer, for all pixels at once. On the ray of the pixel coordinates X,
// Y the planes of two triangles are met at q and q'; the difference q - q' is affine in X, Y, as
// each of them is, but where the planes nearly coincide floats and doubles lose it. Made from
// exact arithmetic once for a pair, it has all its digits. [numerics: coincident triangles]

namespace nuvo {

/// The orders of pairs that were asked for, as far as they are kept. For one thread.
class PlaneOrders {
  public:
    PlaneOrders(const FastScene& scene, const CameraRays& camera)
        : scene_(scene), camera_(camera) {}

    /// A function that is positive where the first of two triangles is nearer, if both are met, or
    /// as near and earlier in the document.
    PixelFunction between(Slot first, Slot second) {
        return kept_.of({first, second}, [&] { return order_of(first, second); });
    }

  private:
    PixelFunction order_of(Slot first, Slot second) const;

    const FastScene& scene_;
    const CameraRays& camera_;
    PairCache<PixelFunction> kept_;
};

}  // namespace nuvo
