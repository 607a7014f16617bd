#include "fast/frame/frame.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fast/frame/frame_tables.h"
#include "fast/frame/frame_worker.h"

// The picture tile by tile: primary rays, surfaces, and for each light its samples, its shadows and
// its sum; then bytes. Tiles share nothing but tables that are only read and the picture they write
// disjoint parts of, so any number of threads gives the same bytes.

namespace nuvo {
namespace {

// In units of the scene's width. Floats tell nothing of a scene seen from beyond; the serial tracer
// takes over, with the same picture.
constexpr double kFarthestCamera = 0x1p20;

}  // namespace

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

bool Frame::can_show(const FastScene& scene, Resolution resolution) {
    if (!scene.is_ordinary()) return false;
    const CameraRays camera(scene.scene().camera, resolution, scene.frame());
    return max_norm(camera.origin) < kFarthestCamera &&
           std::fabs(camera.starts_at) < kFarthestCamera && camera.is_sharp();
}

std::size_t Frame::memory_bytes() const {
    const ShadowTables* const shadow = tables_->shadow;
    return tables_->camera.memory_bytes() + tables_->surfaces.memory_bytes() +
           tables_->hits.memory_bytes() + tables_->lit.memory_bytes() +
           (shadow != nullptr ? shadow->memory_bytes() : tables_->most_bytes);
}

void Frame::find_hits() {
    Hits& hits = tables_->hits;
    const std::vector<TilePlace>& tiles = tables_->tiles;
    hits.tiles.resize(tiles.size());
    if (scene_.has_ellipsoids()) hits.normals.resize(tiles.size());
    for_each_tile([&](Worker& worker, std::size_t i) {
        worker.find(tiles[i], hits.tiles[i], hits.normals_of(i));
        if (!tables_->is_serial) hits.seen.add(hits.tiles[i].slot);
        add(options_.progress, tables_->pixels(i));
    });
}

Image Frame::render() {
    const Resolution size = tables_->rays.resolution;
    Image image = Image::unset(size.width, size.height);
    if (tables_->two_passes) {
        begin(options_.progress, "primary rays", pixel_count(size));
        find_hits();
        StageClock clock(times_ != nullptr);
        if (!tables_->is_serial) make_tables_of_hits(clock);
        if (times_ != nullptr) clock.add_to(times_->tables);
    }
    begin(options_.progress, "pixels", pixel_count(size));
    for_each_tile([&](Worker& worker, std::size_t i) {
        worker.shade(i, image);
        add(options_.progress, tables_->pixels(i));
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
