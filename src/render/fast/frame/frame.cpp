#include "fast/frame/frame.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include "fast/camera/camera_tables.h"
#include "fast/primary/primary.h"
#include "fast/scene/triangle_chunk.h"
#include "fast/shading/shading.h"
#include "fast/shadow/shadow.h"
#include "fast/tile/tile_order.h"
#include "nuvo/math/parallel.h"

// The picture tile by tile: primary rays, surfaces, and for each light its samples, its shadows and
// its sum; then bytes. Tiles share nothing but tables that are only read and the picture they write
// disjoint parts of, so any number of threads gives the same bytes.

namespace nuvo {
namespace {

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

std::uint64_t pixels_of(TilePlace place, Resolution size) {
    const int x = place.column * kMacroSide;
    const int y = place.row * kMacroSide;
    return pixel_count(
        {std::min(kMacroSide, size.width - x), std::min(kMacroSide, size.height - y)});
}

}  // namespace

struct Frame::Tables {
    Tables(const FastScene& scene, const FastOptions& options, Resolution resolution)
        : rays(scene.scene().camera, resolution, scene.frame()),
          tiles(tiles_in_order(resolution, kMacroSide)) {
        shadow.emplace(scene, options.isa, options.threads, TableFilling::kLater);
        camera.emplace(scene, rays, options.isa, options.threads, TableFilling::kLater);
        const auto surfaces = std::make_shared<ShadingTables>(scene, rays, camera->spheres,
                                                              options.isa, TableFilling::kLater);
        fill_tables(scene, options.threads, *shadow, *camera, *surfaces);
        shading.emplace(surfaces, options.redo_exactly);
    }

    CameraRays rays;
    std::vector<TilePlace> tiles;
    std::optional<ShadowTables> shadow;
    std::optional<CameraTables> camera;
    std::optional<ShadingStage> shading;  // copied by each thread; the copies share its tables
};

/// One thread's stages.
class Frame::Worker {
  public:
    Worker(const FastScene& scene, const Tables& tables, const FastOptions& options)
        : scene_(scene),
          fallback_(scene, tables.rays),
          job_{scene, tables.rays, *tables.camera, fallback_, options.redo_exactly, {}},
          primary_(options.isa),
          shadow_(*tables.shadow, options.isa, options.redo_exactly),
          shading_(*tables.shading) {}

    void trace(TilePlace place, Image& image, FastTimes* times) {
        FastTimes spent;
        StageClock clock(times != nullptr);
        macro_.x = place.column * kMacroSide;
        macro_.y = place.row * kMacroSide;
        primary_.trace(job_, macro_);
        clock.add_to(spent.primary);
        const bool quadrics = scene_.slot_end() != scene_.triangle_end();
        for (int i = 0; i < MacroTile::kTiles; ++i) {
            macro_.copy(i, quadrics, tile_);
            if (tile_.x < image.width() && tile_.y < image.height()) shade(image, spent, clock);
        }
        if (times == nullptr) return;
        times->primary += spent.primary;
        times->shadow += spent.shadow;
        times->shading += spent.shading;
    }

  private:
    void shade(Image& image, FastTimes& spent, StageClock& clock) {
        if (hit_anything()) {
            shading_.surface(tile_);
            for (std::size_t light = 0; light < scene_.scene().lights.size(); ++light) {
                TileMask wanted;
                shading_.sample(tile_, light, wanted);
                clock.add_to(spent.shading);
                TileMask lit;
                shadow_.trace(tile_, light, wanted, fallback_, lit);
                clock.add_to(spent.shadow);
                shading_.add(light, lit);
            }
        }
        shading_.finish(tile_, fallback_, image);
        clock.add_to(spent.shading);
    }

    bool hit_anything() const {
        return std::any_of(std::begin(tile_.hit), std::end(tile_.hit),
                           [](std::uint16_t lanes) { return lanes != 0; });
    }

    const FastScene& scene_;
    ExactFallback fallback_;
    PrimaryJob job_;
    PrimaryStage primary_;
    ShadowStage shadow_;
    ShadingStage shading_;
    MacroTile macro_{};
    Tile tile_{};
};

Frame::Frame(const FastScene& scene, const FastOptions& options, Resolution resolution)
    : scene_(scene), options_(options) {
    const double start = seconds_now();
    tables_ = std::make_unique<Tables>(scene, options, resolution);
    table_seconds_ = seconds_now() - start;
}

Frame::~Frame() = default;

std::size_t Frame::memory_bytes() const {
    return tables_->camera->memory_bytes() + tables_->shadow->memory_bytes() +
           tables_->shading->tables().memory_bytes();
}

Image Frame::render(FastTimes* times) {
    const Resolution size = tables_->rays.resolution;
    Image image = Image::unset(size.width, size.height);
    const std::vector<TilePlace>& tiles = tables_->tiles;
    const auto threads = static_cast<std::size_t>(options_.threads);
    std::vector<FastTimes> spent(threads);
    std::vector<std::unique_ptr<Worker>> workers(threads);  // made by their threads
    begin(options_.progress, "pixels", pixel_count(size));
    for_each_index(options_.threads, tiles.size(), [&](std::size_t i, int thread) {
        std::unique_ptr<Worker>& worker = workers[thread];
        if (!worker) worker = std::make_unique<Worker>(scene_, *tables_, options_);
        worker->trace(tiles[i], image, times ? &spent[thread] : nullptr);
        add(options_.progress, pixels_of(tiles[i], size));
    });
    if (times != nullptr) {
        times->tables += table_seconds_;
        for (const FastTimes& part : spent) {
            times->primary += part.primary;
            times->shadow += part.shadow;
            times->shading += part.shading;
        }
    }
    return image;
}

}  // namespace nuvo
