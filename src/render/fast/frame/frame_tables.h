#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>
#include <utility>
#include <vector>

#include "fast/camera/camera_tables.h"
#include "fast/frame/frame.h"
#include "fast/frame/kept_tables.h"
#include "fast/primary/macro_tile.h"
#include "fast/shading/shading_tables.h"
#include "fast/shadow/shadow_tables.h"
#include "fast/tile/triangle_set.h"
#include "nuvo/math/big_vector.h"

namespace nuvo {

/// About how many bytes a light's shadow tables take: planes and entries of all items, or of those
/// that stand before what is seen, which are seldom more than a quarter.
inline std::size_t shadow_bytes(const FastScene& scene, bool listed) {
    constexpr std::size_t kItemBytes = 96;
    return scene.slot_end() * kItemBytes / (listed ? 4 : 1);
}
/// Where shadow tables of all lights would take more, they are made for some lights at a time. Two
/// lights have room however large the scene is: it takes as much itself.
inline std::size_t most_shadow_bytes(const FastScene& scene) {
    return std::max(std::size_t{1} << 30, 2 * shadow_bytes(scene, false));
}

/// What all pixels show.
struct Frame::Hits {
    BigVector<MacroTile> tiles;           // in the order of Tables::tiles
    BigVector<EllipsoidNormals> normals;  // the same; empty: no ellipsoids
    TriangleSet seen;

    EllipsoidNormals* normals_of(std::size_t i) { return normals.empty() ? nullptr : &normals[i]; }
    std::size_t memory_bytes() const {
        return tiles.size() * sizeof(MacroTile) + normals.size() * sizeof(EllipsoidNormals);
    }
};

/// Which pixels the lights reach, by macro tile, tile and light: where shadows are found for a few
/// lights at a time, before anything is shaded.
class LitPixels {
  public:
    LitPixels() = default;
    LitPixels(std::size_t macro_tiles, std::size_t lights)
        : lights_(lights), lanes_(macro_tiles * MacroTile::kTiles * lights) {}

    bool empty() const { return lanes_.empty(); }
    TileMask& of(std::size_t macro_tile, int tile, std::size_t light) {
        const std::size_t of_all = macro_tile * MacroTile::kTiles + static_cast<std::size_t>(tile);
        return lanes_[of_all * lights_ + light];
    }
    std::size_t memory_bytes() const { return vector_bytes(lanes_); }

  private:
    std::size_t lights_ = 0;
    BigVector<TileMask> lanes_;
};

struct Frame::Tables {
    Tables(const FastScene& scene, const FastOptions& options, Resolution resolution,
           KeptTables& kept, ShadowListing listing)
        : rays(scene.scene().camera, resolution, scene.frame()),
          tiles(macro_tiles(resolution)),
          two_passes(listing == ShadowListing::kMeasured ? lists_pay(scene, resolution)
                                                         : listing != ShadowListing::kAll),
          camera(scene, rays, options.isa, options.threads),
          surfaces(scene, rays, camera, options.isa, std::exchange(kept.shading, std::nullopt)) {
        if (two_passes) {
            hits.seen = TriangleSet(scene);
            // Kernels read slot 0 in lanes that show no triangle.
            hits.seen.add(std::array<Slot, 1>{0});
        } else {
            shadow = kept.shadows();
            if (shadow == nullptr || !shadow->complete())
                shadow = &kept.keep_shadows(scene.scene().camera, resolution, [&] {
                    return ShadowTables(scene, options.isa, options.threads);
                });
            surfaces.fill_all(options.threads);
        }
    }

    /// Of macro tile i.
    std::uint64_t pixels(std::size_t i) const {
        return pixel_count({std::min(kMacroSide, rays.resolution.width - tiles[i].x),
                            std::min(kMacroSide, rays.resolution.height - tiles[i].y)});
    }

    CameraRays rays;
    std::vector<TilePlace> tiles;  // of macro tiles
    bool two_passes;
    std::atomic<bool> is_serial = false;  // what is left is for the serial tracer
    CameraTables camera;
    ShadingTables surfaces;
    const ShadowTables* shadow = nullptr;
    bool new_points = false;  // its items were listed for another picture
    Hits hits;
    LitPixels lit;               // empty: found while shading
    std::size_t most_bytes = 0;  // of its shadow tables at a time

  private:
    // Whether it takes less time to ask each pixel twice than to make all tables of shadows, or
    // memory has no room for them.
    static bool lists_pay(const FastScene& scene, Resolution resolution) {
        constexpr std::size_t kPixels = 16;     // that cost as much as the tables of an item
        constexpr std::size_t kMany = 100'000;  // tables of fewer stay near the processor
        const std::vector<Light>& lights = scene.scene().lights;
        const auto shadows = static_cast<std::size_t>(std::count_if(
            lights.begin(), lights.end(), [](const Light& light) { return light.casts_shadow; }));
        if (shadows * shadow_bytes(scene, false) > most_shadow_bytes(scene)) return true;
        return scene.slot_end() > kMany && scene.slot_end() * kPixels > pixel_count(resolution) &&
               shadows > 0;
    }
};

}  // namespace nuvo
