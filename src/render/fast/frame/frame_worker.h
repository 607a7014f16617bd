#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>

#include "fast/frame/frame_tables.h"
#include "fast/frame/serial_pixels.h"
#include "fast/primary/primary.h"
#include "fast/shading/shading.h"
#include "fast/shadow/shadow.h"
#include "nuvo/math/parallel.h"

namespace nuvo {

inline double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

/// Adds up the time between marks; where nobody asks, not even the clock is read.
class StageClock {
  public:
    explicit StageClock(bool on) : on_(on), last_(on ? seconds_now() : 0) {}
    void add_to(double& stage) {
        if (!on_) return;
        const double now = seconds_now();
        stage += now - last_;
        last_ = now;
    }
    /// What has passed is no stage's.
    void skip() {
        if (on_) last_ = seconds_now();
    }

  private:
    bool on_;
    double last_;
};

/// One thread's stages.
class Frame::Worker {
  public:
    /// `clocked`: spent() is asked for.
    Worker(SerialTree& serial, Tables& tables, KeptTables::OfThread& kept,
           const FastOptions& options, bool clocked)
        : serial_(serial),
          scene_(serial.scene()),
          tables_(tables),
          kept_(kept),
          options_(options),
          clocked_(clocked),
          fallback_(scene_, tables.rays),
          job_{scene_, tables.rays, tables.camera, fallback_, options.redo_exactly, {}},
          primary_(options.isa),
          shading_(tables.surfaces, options.redo_exactly) {
        std::swap(fallback_.stage_counts(), kept_.stages);
    }

    /// Finds what a macro tile shows, unless the serial tracer has taken over.
    void find(TilePlace place, MacroTile& macro, EllipsoidNormals* normals) {
        macro.x = place.x;
        macro.y = place.y;
        if (tables_.is_serial) return;
        StageClock clock(clocked_);
        constexpr std::uint64_t kPixels = kMacroSide * kMacroSide;
        found_ += kPixels;
        if (options_.redo_exactly)
            fallback_.allow(allowed_tests(scene_, pixel_count(tables_.rays.resolution),
                                          options_.threads, found_, kPixels));
        primary_.trace(job_, macro, normals);
        give_up_if_exhausted();
        clock.add_to(spent_.primary);
    }
    /// Calls use(light, tile, wanted lanes) for the tiles of a macro tile and those of the lights
    /// that cast shadows.
    template <typename Use>
    void want(std::size_t i, LightRange lights, Use&& use) {
        for_each_tile(tables_.hits.tiles[i], tables_.hits.normals_of(i), [&](int) {
            if (!hit_anything()) return;
            shading_.surface(tile_);
            for (std::size_t light = lights.first; light < lights.last; ++light) {
                if (!scene_.scene().lights[light].casts_shadow) continue;
                TileMask wanted;
                shading_.sample(tile_, light, wanted);
                use(light, tile_, wanted);
            }
        });
    }
    /// Finds which pixels of a macro tile some lights reach.
    void find_lit(std::size_t i, LightRange lights) {
        StageClock clock(clocked_);
        take_shadows();
        for_each_tile(tables_.hits.tiles[i], tables_.hits.normals_of(i), [&](int tile) {
            if (tables_.is_serial || !hit_anything()) return;
            shading_.surface(tile_);
            for (std::size_t light = lights.first; light < lights.last; ++light)
                trace_shadows(light, tables_.lit.of(i, tile, light), clock);
            give_up_if_exhausted();
        });
    }
    /// Other shadow tables are made.
    void forget_shadows() { shadow_.reset(); }
    void shade(std::size_t i, Image& image) {
        const TilePlace place = tables_.tiles[i];
        if (tables_.is_serial) return trace_serially(place.x, place.y, kMacroSide, image);
        if (tables_.lit.empty()) take_shadows();
        if (tables_.two_passes) {
            shade(i, tables_.hits.tiles[i], tables_.hits.normals_of(i), image);
            return;
        }
        EllipsoidNormals* const normals = scene_.has_ellipsoids() ? &normals_ : nullptr;
        find(place, macro_, normals);
        shade(i, macro_, normals, image);
    }

    /// After the last tile.
    void finish(Image& image) {
        StageClock clock(clocked_);
        shading_.decide_open(fallback_, image);
        std::swap(fallback_.stage_counts(), kept_.stages);
        clock.add_to(spent_.shading);
    }

    const FastTimes& spent() const { return spent_; }

  private:
    template <typename Use>
    void for_each_tile(const MacroTile& macro, const EllipsoidNormals* normals, Use&& use) {
        const Resolution size = tables_.rays.resolution;
        for (int i = 0; i < MacroTile::kTiles; ++i) {
            if (macro.tile_x(i) >= size.width || macro.tile_y(i) >= size.height) continue;
            macro.show(i, normals, tile_);
            use(i);
        }
    }
    void shade(std::size_t macro_tile, const MacroTile& macro, const EllipsoidNormals* normals,
               Image& image) {
        StageClock clock(clocked_);
        for_each_tile(macro, normals,
                      [&](int tile) { shade_tile(macro_tile, tile, image, clock); });
    }
    void shade_tile(std::size_t macro_tile, int tile, Image& image, StageClock& clock) {
        if (!tables_.is_serial && hit_anything()) light_tile(macro_tile, tile, clock);
        give_up_if_exhausted();
        if (tables_.is_serial) return trace_serially(tile_.x, tile_.y, kTileSide, image);
        shading_.finish(tile_, fallback_, image);
        clock.add_to(spent_.shading);
    }
    void light_tile(std::size_t macro_tile, int tile, StageClock& clock) {
        shading_.surface(tile_);
        for (std::size_t light = 0; light < scene_.scene().lights.size(); ++light) {
            TileMask lit;
            if (tables_.lit.empty()) {
                trace_shadows(light, lit, clock);
            } else {
                shading_.sample(tile_, light, lit);
                lit = tables_.lit.of(macro_tile, tile, light);
            }
            shading_.add(light, lit);
        }
    }
    void take_shadows() {
        if (!shadow_)
            shadow_.emplace(*tables_.shadow, kept_.pairs, options_.isa, options_.redo_exactly,
                            tables_.new_points);
    }
    // Samples the light, too.
    void trace_shadows(std::size_t light, TileMask& lit, StageClock& clock) {
        TileMask wanted;
        shading_.sample(tile_, light, wanted);
        clock.add_to(spent_.shading);
        shadow_->trace(tile_, light, wanted, fallback_, lit);
        clock.add_to(spent_.shadow);
    }

    void give_up_if_exhausted() {
        if (fallback_.is_exhausted()) tables_.is_serial = true;
    }
    // A square of the picture.
    void trace_serially(int left, int top, int side, Image& image) {
        if (!pixels_) pixels_.emplace(serial_);
        pixels_->draw(tables_.rays.rays, left, top, side, image);
    }

    bool hit_anything() const {
        return std::any_of(tile_.hit.begin(), tile_.hit.end(),
                           [](std::uint16_t lanes) { return lanes != 0; });
    }

    SerialTree& serial_;
    const FastScene& scene_;
    Tables& tables_;
    KeptTables::OfThread& kept_;
    const FastOptions& options_;
    bool clocked_;
    std::uint64_t found_ = 0;             // pixels
    std::optional<SerialPixels> pixels_;  // once the serial tracer has taken over
    FastTimes spent_;
    ExactFallback fallback_;
    PrimaryJob job_;
    PrimaryStage primary_;
    std::optional<ShadowStage> shadow_;
    ShadingStage shading_;
    MacroTile macro_{};
    EllipsoidNormals normals_{};
    Tile tile_{};
};

template <typename Work>
void Frame::for_each_tile(Work&& work) {
    for_each_index(options_.threads, tables_->tiles.size(), [&](std::size_t i, int thread) {
        std::unique_ptr<Worker>& worker = workers_[static_cast<std::size_t>(thread)];
        if (!worker)
            worker = std::make_unique<Worker>(serial_, *tables_, kept_.of_thread(thread), options_,
                                              times_ != nullptr);
        work(*worker, i);
    });
}

}  // namespace nuvo
