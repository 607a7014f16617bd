#pragma once

#include <array>
#include <span>
#include <vector>

#include "embree_scene.h"
#include "nuvo/image/image.h"
#include "nuvo/scene/camera.h"

namespace nuvo::bench {

/// How far a frame goes; the costs of its stages are the differences.
enum class Depth {
    kPrimary,  ///< primary rays only
    kTrace,    ///< and what shadow rays need, and these
    kWhole,    ///< and the colors
};

/// How Embree is asked.
struct EmbreeMode {
    int primary_width = 16;  ///< 1, 4, 8 or 16 rays a call
    bool primary_coherent = true;
    int shadow_width = 16;
    bool shadow_coherent = true;
};

/// Renders frames of one Embree scene and resolution as a good program in single precision would:
/// tiles that stay in the cache, square packets, one geometric pass, shadow rays of one light
/// packed close, none where the light adds nothing, no power function without a specular color.
class EmbreeFrame {
  public:
    EmbreeFrame(const EmbreeScene& scene, Resolution resolution);

    /// The picture is black unless `depth` is kWhole.
    Image render(const EmbreeMode& mode, Depth depth, int threads = 1) const;

  private:
    struct Tile;
    template <int N>
    void make_rays(int x0, int y0, RTCRayHitNt<N>& pack, std::array<int, N>& valid) const;
    template <int N>
    void trace_primary(Tile& tile, const EmbreeMode& mode, Depth depth, Image& image) const;
    template <int N>
    void trace_shadow_packets(Tile& tile, const EmbreeMode& mode) const;
    void trace_shadows(Tile& tile, const EmbreeMode& mode) const;
    void add_light(Tile& tile, const FloatLight& light) const;
    void render_tile(Tile& tile, const EmbreeMode& mode, Depth depth, Image& image) const;

    const EmbreeScene& scene_;
    Resolution resolution_;
    struct OfPixel {
        Float3 corner;  // at the picture's upper left one
        Float3 across;  // from one pixel to the next
        Float3 down;    // from one row to the next

        Float3 at(float x, float y) const { return corner + across * x + down * y; }
    };
    OfPixel origin_;
    OfPixel direction_;
    float bias_ = 0;  // of shadow rays, along the geometric normal
};

/// One nearest hit of rtcIntersect1.
struct SingleHit {
    bool hit = false;
    bool on_sphere = false;
    unsigned primitive = 0;
    float t = 0;
};

/// Single rays in any order, directions made unit: t is a distance.
std::vector<SingleHit> closest_hits(const EmbreeScene& scene, std::span<const Ray> rays);

}  // namespace nuvo::bench
