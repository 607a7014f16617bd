#include "fast/frame/count.h"

#include <algorithm>
#include <memory>

#include "fast/primary/primary.h"

// Which lights reach a point is asked of the serial tracer's own code, lane by lane: the float
// stages may trace a shadow ray more than needed, or one less.

namespace nuvo {
namespace {

std::uint64_t shadow_rays(const FastScene& scene, const ExactFallback& fallback, const Tile& tile) {
    const std::vector<Light>& lights = scene.scene().lights;
    std::uint64_t rays = 0;
    for (int lane = 0; lane < kTileLanes; ++lane) {
        if ((tile.hit[lane / kBlockLanes] >> lane % kBlockLanes & 1) == 0) continue;
        fallback.color(tile.x + lane_x(lane), tile.y + lane_y(lane), tile.slot[lane],
                       [&](std::size_t light) {
                           rays += lights[light].casts_shadow ? 1 : 0;
                           return false;
                       });
    }
    return rays;
}

}  // namespace

RayCounts count_rays(const FastScene& scene, InstructionSet isa, Resolution resolution,
                     Progress* progress) {
    const CameraRays camera(scene.scene().camera, resolution, scene.frame());
    CameraTables tables(scene, camera, isa);
    const ExactFallback fallback(scene, camera);
    const auto job =
        std::make_unique<PrimaryJob>(PrimaryJob{scene, camera, tables, fallback, true, {}});
    const PrimaryStage primary(isa);
    RayCounts counts;
    counts.primary_rays = pixel_count(resolution);
    begin(progress, "pixels", counts.primary_rays);
    const auto macro = std::make_unique<MacroTile>();
    Tile tile;
    for (macro->y = 0; macro->y < resolution.height; macro->y += kMacroSide) {
        for (macro->x = 0; macro->x < resolution.width; macro->x += kMacroSide) {
            primary.trace(*job, *macro, nullptr);
            for (int i = 0; i < MacroTile::kTiles; ++i) {
                macro->show(i, nullptr, tile);
                counts.shadow_rays += shadow_rays(scene, fallback, tile);
            }
        }
        const int rows = std::min(kMacroSide, resolution.height - macro->y);
        add(progress, pixel_count({resolution.width, rows}));
    }
    return counts;
}

}  // namespace nuvo
