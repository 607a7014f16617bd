#include "fast/shading/shading.h"

#include <bit>

namespace nuvo {

ShadingStage::ShadingStage(const ShadingTables& tables, bool redo_exactly)
    : tables_(&tables),
      redo_exactly_(redo_exactly),
      lit_(tables_->scene.scene().lights.size()),
      open_(lit_.size()) {
    pick_surface_kernel(tables_->isa, kernels_);
    pick_light_kernels(tables_->isa, kernels_);
    pick_finish_kernel(tables_->isa, kernels_);
}

void ShadingStage::surface(Tile& tile) {
    for (TileMask& lanes : lit_) lanes.fill(0);
    kernels_.surface(*tables_, tile, scratch_);
}

void ShadingStage::sample(const Tile& tile, std::size_t light, TileMask& wanted) {
    kernels_.sample(*tables_, tile, light, scratch_, wanted);
}

void ShadingStage::add(std::size_t light, const TileMask& lit) {
    lit_[light] = lit;
    kernels_.add(*tables_, light, lit, scratch_);
}

int ShadingStage::finish(const Tile& tile, const ExactFallback& fallback, Image& image) {
    TileMask uncertain;
    if (!kernels_.finish(*tables_, tile, scratch_, image, uncertain) || !redo_exactly_) return 0;
    int count = 0;
    for (std::size_t b = 0; b < kTileBlocks; ++b) {
        for (unsigned bits = uncertain[b]; bits != 0; bits &= bits - 1) {
            const int bit = std::countr_zero(bits);
            const int lane = static_cast<int>(b) * kBlockLanes + bit;
            const auto is_lit = [&](std::size_t light) { return (lit_[light][b] >> bit & 1) != 0; };
            open_.add(tile.x + lane_x(lane), tile.y + lane_y(lane), tile.slot[lane], is_lit,
                      fallback, image);
            ++count;
        }
    }
    return count;
}

}  // namespace nuvo
