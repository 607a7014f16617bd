#include "fast/shading/shading.h"

#include <bit>

#include "fast/simd/dispatch.h"
#include "nuvo/render/shading.h"

namespace nuvo {

ShadingStage::ShadingStage(const ShadingTables& tables, bool redo_exactly)
    : tables_(&tables), redo_exactly_(redo_exactly), lit_(tables_->scene.scene().lights.size()) {
    pick_surface_kernel(tables_->isa, kernels_);
    pick_light_kernels(tables_->isa, kernels_);
    pick_finish_kernel(tables_->isa, kernels_);
}

void ShadingStage::surface(Tile& tile) {
    for (LitLanes& lanes : lit_) lanes.fill(0);
    kernels_.surface(*tables_, tile, scratch_);
}

void ShadingStage::sample(const Tile& tile, std::size_t light, TileMask& wanted) {
    kernels_.sample(*tables_, tile, light, scratch_, wanted);
}

void ShadingStage::add(std::size_t light, const TileMask& lit) {
    std::copy(std::begin(lit), std::end(lit), lit_[light].begin());
    kernels_.add(*tables_, light, lit, scratch_);
}

int ShadingStage::finish(const Tile& tile, const ExactFallback& fallback, Image& image) {
    TileMask uncertain;
    const bool any = kernels_.finish(*tables_, tile, scratch_, image, uncertain);
    return any && redo_exactly_ ? redo(tile, uncertain, fallback, image) : 0;
}

int ShadingStage::redo(const Tile& tile, const TileMask& uncertain, const ExactFallback& fallback,
                       Image& image) {
    int count = 0;
    for (std::size_t b = 0; b < kTileBlocks; ++b) {
        for (unsigned bits = uncertain[b]; bits != 0; bits &= bits - 1) {
            const int bit = std::countr_zero(bits);
            const int lane = static_cast<int>(b) * kBlockLanes + bit;
            const int x = tile.x + lane_x(lane);
            const int y = tile.y + lane_y(lane);
            image.at(x, y) =
                quantized(fallback.color(x, y, tile.slot[lane], [&](std::size_t light) {
                    return (lit_[light][b] >> bit & 1) != 0;
                }));
            ++count;
        }
    }
    return count;
}

}  // namespace nuvo
