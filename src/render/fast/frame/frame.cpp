#include "fast/frame/frame.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <optional>
#include <utility>

#include "fast/camera/camera_tables.h"
#include "fast/frame/kept_tables.h"
#include "fast/frame/serial_pixels.h"
#include "fast/light/wanted_depths.h"
#include "fast/primary/primary.h"
#include "fast/shading/shading.h"
#include "fast/shadow/shadow.h"
#include "fast/tile/tile_order.h"
#include "fast/tile/triangle_set.h"
#include "nuvo/math/parallel.h"

// The picture tile by tile: primary rays, surfaces, and for each light its samples, its shadows and
// its sum; then bytes. Tiles share nothing but tables that are only read and the picture they write
// disjoint parts of, so any number of threads gives the same bytes.

namespace nuvo {
namespace {

// In units of the scene's width. Floats tell nothing of a scene seen from beyond; the serial tracer
// takes over, with the same picture.
constexpr double kFarthestCamera = 0x1p20;

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

// Adds up the time between marks; where nobody asks, not even the clock is read.
class StageClock {
  public:
    explicit StageClock(bool on) : on_(on), last_(on ? seconds_now() : 0) {}
    void add_to(double& stage) {
        if (!on_) return;
        const double now = seconds_now();
        stage += now - last_;
        last_ = now;
    }

  private:
    bool on_;
    double last_;
};

std::size_t lane_count(const TileMask& lanes) {
    std::size_t count = 0;
    for (const std::uint16_t block : lanes) count += static_cast<std::size_t>(std::popcount(block));
    return count;
}

std::uint64_t pixels_of(TilePlace place, Resolution size) {
    const int x = place.column * kMacroSide;
    const int y = place.row * kMacroSide;
    return pixel_count(
        {std::min(kMacroSide, size.width - x), std::min(kMacroSide, size.height - y)});
}

}  // namespace

// What all pixels show.
struct Frame::Hits {
    BigVector<MacroTile> tiles;         // in the order of Tables::tiles
    BigVector<MacroQuadrics> quadrics;  // the same; empty: the scene has none
    TriangleSet seen;

    MacroQuadrics* quadrics_of(std::size_t i) { return quadrics.empty() ? nullptr : &quadrics[i]; }
    std::size_t memory_bytes() const {
        return tiles.size() * sizeof(MacroTile) + quadrics.size() * sizeof(MacroQuadrics);
    }
};

struct Frame::Tables {
    Tables(const FastScene& scene, const FastOptions& options, Resolution resolution,
           KeptTables& kept, ShadowListing listing)
        : rays(scene.scene().camera, resolution, scene.frame()),
          tiles(tiles_in_order(resolution, kMacroSide)),
          two_passes(listing == ShadowListing::kMeasured ? shadows_pay(scene, resolution)
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

    CameraRays rays;
    std::vector<TilePlace> tiles;
    bool two_passes;
    std::atomic<bool> is_serial = false;  // what is left is for the serial tracer
    CameraTables camera;
    ShadingTables surfaces;
    const ShadowTables* shadow = nullptr;
    bool new_points = false;  // its items were listed for another picture
    Hits hits;

  private:
    // Whether it takes less time to ask each pixel twice than to make all tables of shadows.
    static bool shadows_pay(const FastScene& scene, Resolution resolution) {
        constexpr std::size_t kPixels = 16;     // that cost as much as the tables of an item
        constexpr std::size_t kMany = 100'000;  // tables of fewer stay near the processor
        const std::vector<Light>& lights = scene.scene().lights;
        return scene.slot_end() > kMany && scene.slot_end() * kPixels > pixel_count(resolution) &&
               std::any_of(lights.begin(), lights.end(),
                           [](const Light& light) { return light.casts_shadow; });
    }
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
    void find(TilePlace place, MacroTile& macro, MacroQuadrics* quadrics) {
        macro.x = place.column * kMacroSide;
        macro.y = place.row * kMacroSide;
        if (tables_.is_serial) return;
        StageClock clock(clocked_);
        constexpr std::uint64_t kPixels = kMacroSide * kMacroSide;
        found_ += kPixels;
        if (options_.redo_exactly)
            fallback_.allow(allowed_tests(scene_, pixel_count(tables_.rays.resolution),
                                          options_.threads, found_, kPixels));
        primary_.trace(job_, macro, quadrics);
        give_up_if_exhausted();
        clock.add_to(spent_.primary);
    }
    /// Calls use(light, tile, wanted lanes) for the tiles of a macro tile and lights with shadows.
    template <typename Use>
    void want(std::size_t i, Use&& use) {
        for_each_tile(tables_.hits.tiles[i], tables_.hits.quadrics_of(i), [&] {
            if (!hit_anything()) return;
            shading_.surface(tile_);
            for (std::size_t light = 0; light < scene_.scene().lights.size(); ++light) {
                if (!scene_.scene().lights[light].casts_shadow) continue;
                TileMask wanted;
                shading_.sample(tile_, light, wanted);
                use(light, tile_, wanted);
            }
        });
    }
    void shade(std::size_t i, Image& image) {
        const TilePlace place = tables_.tiles[i];
        if (tables_.is_serial)
            return trace_serially(place.column * kMacroSide, place.row * kMacroSide, kMacroSide,
                                  image);
        if (!shadow_)
            shadow_.emplace(*tables_.shadow, kept_.pairs, options_.isa, options_.redo_exactly,
                            tables_.new_points);
        if (tables_.two_passes) {
            shade(tables_.hits.tiles[i], tables_.hits.quadrics_of(i), image);
            return;
        }
        const bool quadrics = scene_.slot_end() != scene_.triangle_end();
        find(place, macro_, &quadrics_);
        shade(macro_, quadrics ? &quadrics_ : nullptr, image);
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
    void for_each_tile(const MacroTile& macro, const MacroQuadrics* quadrics, Use&& use) {
        const Resolution size = tables_.rays.resolution;
        for (int i = 0; i < MacroTile::kTiles; ++i) {
            if (macro.tile_x(i) >= size.width || macro.tile_y(i) >= size.height) continue;
            macro.show(i, quadrics, tile_);
            use();
        }
    }
    void shade(const MacroTile& macro, const MacroQuadrics* quadrics, Image& image) {
        StageClock clock(clocked_);
        for_each_tile(macro, quadrics, [&] { shade_tile(image, clock); });
    }
    void shade_tile(Image& image, StageClock& clock) {
        if (tables_.is_serial) return trace_serially(tile_.x, tile_.y, kTileSide, image);
        if (hit_anything()) {
            shading_.surface(tile_);
            for (std::size_t light = 0; light < scene_.scene().lights.size(); ++light) {
                TileMask wanted;
                shading_.sample(tile_, light, wanted);
                clock.add_to(spent_.shading);
                TileMask lit;
                shadow_->trace(tile_, light, wanted, fallback_, lit);
                clock.add_to(spent_.shadow);
                shading_.add(light, lit);
            }
        }
        give_up_if_exhausted();
        if (tables_.is_serial) return trace_serially(tile_.x, tile_.y, kTileSide, image);
        shading_.finish(tile_, fallback_, image);
        clock.add_to(spent_.shading);
    }

    void give_up_if_exhausted() {
        if (fallback_.is_exhausted()) tables_.is_serial = true;
    }
    // A square of the picture.
    void trace_serially(int left, int top, int side, Image& image) {
        if (!pixels_) pixels_.emplace(serial_);
        const Resolution size = tables_.rays.resolution;
        for (int y = top; y < std::min(top + side, size.height); ++y)
            for (int x = left; x < std::min(left + side, size.width); ++x)
                image.at(x, y) = pixels_->pixel(tables_.rays.rays.ray(x, y));
    }

    bool hit_anything() const {
        return std::any_of(std::begin(tile_.hit), std::end(tile_.hit),
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
    MacroQuadrics quadrics_{};
    Tile tile_{};
};

Frame::Frame(SerialTree& serial, const FastOptions& options, Resolution resolution,
             FastTimes* times, KeptTables& kept, ShadowListing listing)
    : serial_(serial),
      scene_(serial.scene()),
      options_(options),
      times_(times),
      kept_(kept),
      listing_(listing) {
    StageClock clock(times != nullptr);
    kept.begin(scene_, options.threads);
    tables_ = std::make_unique<Tables>(scene_, options, resolution, kept, listing);
    workers_.resize(static_cast<std::size_t>(options.threads));
    if (times != nullptr) clock.add_to(times->tables);
}

Frame::~Frame() { kept_.shading.emplace(std::move(tables_->surfaces.triangles)); }

// Tables are for rays from one point.
bool Frame::can_show(const FastScene& scene) {
    const Camera& camera = scene.scene().camera;
    return scene.is_ordinary() && !camera.window &&
           max_norm(scene.frame().local(camera.position)) < kFarthestCamera;
}

std::size_t Frame::memory_bytes() const {
    return tables_->camera.memory_bytes() + tables_->surfaces.memory_bytes() +
           tables_->hits.memory_bytes() + (tables_->shadow ? tables_->shadow->memory_bytes() : 0);
}

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

void Frame::find_hits() {
    Hits& hits = tables_->hits;
    const std::vector<TilePlace>& tiles = tables_->tiles;
    hits.tiles.resize(tiles.size());
    if (scene_.slot_end() != scene_.triangle_end()) hits.quadrics.resize(tiles.size());
    for_each_tile([&](Worker& worker, std::size_t i) {
        worker.find(tiles[i], hits.tiles[i], hits.quadrics_of(i));
        if (!tables_->is_serial) hits.seen.add(hits.tiles[i].slot);
        add(options_.progress, pixels_of(tiles[i], tables_->rays.resolution));
    });
}

void Frame::make_tables_of_hits() {
    const TriangleSet& seen = tables_->hits.seen;
    tables_->surfaces.fill(seen, options_.threads);
    const Camera& camera = scene_.scene().camera;
    const Resolution size = tables_->rays.resolution;
    tables_->shadow = kept_.shadows();
    const bool is_first = tables_->shadow == nullptr;
    if (!is_first && listing_ != ShadowListing::kWanted) {
        if (kept_.serve_all_of(camera, size)) return;
        if (serves(*tables_->shadow)) {
            tables_->new_points = true;
            return;
        }
    }
    tables_->shadow = &kept_.keep_shadows(camera, size, [&] {
        return ShadowTables(scene_, options_.isa, options_.threads,
                            find_wanted(listed_lights(), !is_first));
    });
}

// Calls use(light, tile, wanted lanes) as Worker::want() does, for one of 16 tiles.
template <typename Use>
void Frame::for_some_points(Use&& use) {
    constexpr std::size_t kStep = 16;
    for_each_tile([&](Worker& worker, std::size_t i) {
        if (i % kStep == 0) worker.want(i, use);
    });
}

// By light: whether its shadows are listed for the points that it may reach. Where the picture
// shows much, most may hide something from lights that reach much of it.
std::vector<char> Frame::listed_lights() {
    constexpr std::size_t kMostSeen = 4;  // of all triangles
    constexpr std::size_t kMostLit = 8;   // of the points seen
    const std::size_t lights = scene_.scene().lights.size();
    if (listing_ != ShadowListing::kMeasured ||
        tables_->hits.seen.size() * kMostSeen <= scene_.slot_end())
        return std::vector<char>(lights, 1);
    std::vector<std::atomic<std::size_t>> seen(lights);
    std::vector<std::atomic<std::size_t>> lit(lights);
    for_some_points([&](std::size_t light, const Tile& tile, const TileMask& wanted) {
        seen[light] += lane_count(tile.hit);
        lit[light] += lane_count(wanted);
    });
    std::vector<char> listed(lights);
    for (std::size_t light = 0; light < lights; ++light)
        listed[light] = lit[light] * kMostLit <= seen[light] ? 1 : 0;
    return listed;
}

// Whether kept tables list enough for all but a few points, as far as some tiles tell; the few walk
// the octree.
bool Frame::serves(const ShadowTables& kept) {
    if (listing_ == ShadowListing::kKept || kept.complete()) return true;
    constexpr std::size_t kMost = 128;  // points to one that is not served
    std::atomic<std::size_t> asked = 0;
    std::atomic<std::size_t> served = 0;
    for_some_points([&](std::size_t light, const Tile& tile, TileMask& lanes) {
        asked += lane_count(lanes);
        if (kept.table(light).wanted) kept.table(light).wanted->keep_covered(tile, lanes);
        served += lane_count(lanes);
    });
    return (asked - served) * kMost <= asked;
}

// Of some lights, where they tell places, how deep the points are that this picture shows;
// `and_near`: and those near them.
std::vector<std::optional<WantedDepths>> Frame::find_wanted(const std::vector<char>& lights,
                                                            bool and_near) {
    std::vector<std::optional<WantedDepths>> all(lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Light& light = scene_.scene().lights[i];
        if (light.casts_shadow && lights[i] != 0)
            all[i] = WantedDepths::of(scene_, LightPoint(light, scene_.frame()), options_.isa);
    }
    if (std::none_of(all.begin(), all.end(), [](const auto& depths) { return depths.has_value(); }))
        return all;
    for_each_tile([&](Worker& worker, std::size_t i) {
        worker.want(i, [&](std::size_t light, const Tile& tile, const TileMask& wanted) {
            if (all[light]) all[light]->add(tile, wanted);
        });
    });
    for (std::optional<WantedDepths>& depths : all) {
        if (!depths) continue;
        if (and_near) depths->widen();
        depths->finish();
    }
    return all;
}

Image Frame::render() {
    const Resolution size = tables_->rays.resolution;
    Image image = Image::unset(size.width, size.height);
    if (tables_->two_passes) {
        begin(options_.progress, "primary rays", pixel_count(size));
        find_hits();
        StageClock clock(times_ != nullptr);
        if (!tables_->is_serial) make_tables_of_hits();
        if (times_ != nullptr) clock.add_to(times_->tables);
    }
    begin(options_.progress, "pixels", pixel_count(size));
    for_each_tile([&](Worker& worker, std::size_t i) {
        worker.shade(i, image);
        add(options_.progress, pixels_of(tables_->tiles[i], size));
    });
    for (const std::unique_ptr<Worker>& worker : workers_) {
        if (!worker) continue;
        worker->finish(image);
        if (times_ == nullptr) continue;
        times_->primary += worker->spent().primary;
        times_->shadow += worker->spent().shadow;
        times_->shading += worker->spent().shading;
    }
    return image;
}

}  // namespace nuvo
