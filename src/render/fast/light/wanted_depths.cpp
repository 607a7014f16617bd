#include "fast/light/wanted_depths.h"

#include <algorithm>
#include <atomic>

#include "nuvo/math/error_bounds.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/light/wanted_depths.cpp"
#include <hwy/foreach_target.h>

#include "fast/light/counted_points.h"
#include "fast/light/light_ranges.h"
#include "fast/simd/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

bool start_map(const LightPoint& light, const FastScene& scene, LightMap& map, float (&extent)[2]) {
    ItemRanges ranges;
    return ranges.start(light, scene, map, extent);
}

HWY_INLINE Floats errors_of(const Tile& tile, int b) {
    return Floats::load(tile.point_error + b * kBlockLanes);
}
HWY_INLINE LightPlaces places_of(const WantedDepths& depths, const Tile& tile, int b) {
    return {depths.map(), depths.light(), points_of(tile, b), errors_of(tile, b)};
}

void deepen(float* cells, std::int32_t place, float depth) {
    const std::atomic_ref<float> cell(cells[place]);
    float before = cell.load(std::memory_order_relaxed);
    while (before < depth &&
           !cell.compare_exchange_weak(before, depth, std::memory_order_relaxed)) {
    }
}

void add_points(const WantedDepths& depths, float* cells, const Tile& tile,
                const TileMask& wanted) {
    for (int b = 0; b < kTileBlocks; ++b) {
        if (wanted[b] == 0) continue;
        const CountedPoints points(depths, places_of(depths, tile, b), errors_of(tile, b),
                                   wanted[b]);
        if (points.lanes == 0) continue;
        alignas(64) std::int32_t place[kBlockLanes];
        points.cell.store(place);
        for (std::uint32_t todo = points.single; todo != 0;) {
            const std::int32_t here = place[std::countr_zero(todo)];
            const std::uint32_t same = todo & (points.cell == Ints(here)).bits();
            todo ^= same;
            deepen(
                cells, here,
                highest(select(RayMask::from_bits(same), points.depth, Floats(-kFloatInfinity))));
        }
        if (HWY_UNLIKELY(points.lanes != points.single))
            points.for_each_of_spread(
                [&](std::int32_t cell, float depth, int) { deepen(cells, cell, depth); });
    }
}

void covered_points(const WantedDepths& depths, const Tile& tile, TileMask& lanes) {
    for (int b = 0; b < kTileBlocks; ++b)
        if (lanes[b] != 0)
            lanes[b] = static_cast<std::uint16_t>(
                covered(depths, places_of(depths, tile, b), errors_of(tile, b), lanes[b]));
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"

namespace nuvo {
namespace {

constexpr int kStepBits = std::countr_zero(static_cast<unsigned>(kLightSteps));
constexpr int kPlaneSide = 512;
constexpr int kFaceSide = 256;
// Points that may be so many cells off are not counted: they would be all over the plane.
constexpr float kMostCells = 4;

}  // namespace

std::optional<WantedDepths> WantedDepths::of(const FastScene& scene, const LightPoint& light,
                                             InstructionSet isa) {
    WantedDepths out(light, isa);
    LightMap& map = out.map_;
    float extent[2];
    if (!(NUVO_FOR_ISA(isa, start_map))(light, scene, map, extent)) return std::nullopt;
    out.cells_a_side_ = map.inside ? kFaceSide : kPlaneSide;
    out.step_bits_ = kStepBits - std::countr_zero(static_cast<unsigned>(out.cells_a_side_));
    for (int i = 0; i < 2; ++i) map.steps[i] = static_cast<float>(kLightSteps) / extent[i];
    out.width_ = std::max(extent[0], extent[1]) / static_cast<float>(out.cells_a_side_);
    map.most_moved =
        kMostCells * std::min(extent[0], extent[1]) / static_cast<float>(out.cells_a_side_);
    std::size_t size = 0;
    for (int side = out.cells_a_side_; side > 0; side /= 2) {
        out.level_starts_.push_back(static_cast<std::int32_t>(size));
        size += static_cast<std::size_t>(map.faces() * side * side);
    }
    out.cells_.resize(size);
    std::fill(out.cells_.begin(), out.cells_.end(), -kFloatInfinity);
    return out;
}

void WantedDepths::add(const Tile& tile, const TileMask& wanted) {
    (NUVO_FOR_ISA(isa_, add_points))(*this, cells_.data(), tile, wanted);
}

void WantedDepths::keep_covered(const Tile& tile, TileMask& lanes) const {
    (NUVO_FOR_ISA(isa_, covered_points))(*this, tile, lanes);
}

// Each cell takes the greatest depth of its neighbours on the face, and more as by a slope of 1
// across a cell.
void WantedDepths::widen() {
    const auto side = static_cast<std::size_t>(cells_a_side_);
    std::vector<float> rows[3];  // the greatest of three cells beside each other
    for (std::vector<float>& row : rows) row.resize(side);
    const auto fill = [&](const float* from, std::vector<float>& to) {
        to[0] = std::max(from[0], from[1]);
        for (std::size_t x = 1; x + 1 < side; ++x)
            to[x] = std::max(from[x], std::max(from[x - 1], from[x + 1]));
        to[side - 1] = std::max(from[side - 2], from[side - 1]);
    };
    for (int face = 0; face < map_.faces(); ++face) {
        float* const cells = cells_.data() + static_cast<std::size_t>(face) * side * side;
        fill(cells, rows[0]);
        rows[1] = rows[0];
        for (std::size_t y = 0; y < side; ++y) {
            if (y + 1 < side) fill(cells + (y + 1) * side, rows[(y + 2) % 3]);
            const float* const last = rows[y % 3].data();
            const float* const here = rows[(y + 1) % 3].data();
            const float* const next = rows[(y + 1 < side ? y + 2 : y + 1) % 3].data();
            for (std::size_t x = 0; x < side; ++x) {
                const float most = std::max(here[x], std::max(last[x], next[x]));
                cells[y * side + x] = map_.inside ? most * (1 + width_) : most + width_;
            }
        }
    }
}

void WantedDepths::finish() {
    for (std::size_t level = 1; level < level_starts_.size(); ++level) {
        const int side = cells_a_side_ >> level;
        const float* const from = cells_.data() + level_starts_[level - 1];
        float* const to = cells_.data() + level_starts_[level];
        for (int y = 0; y < map_.faces() * side; ++y)  // rows of all faces
            for (int x = 0; x < side; ++x) {
                const float* const four = from + (2 * y * 2 * side) + 2 * x;
                to[y * side + x] = std::max(std::max(four[0], four[1]),
                                            std::max(four[2 * side], four[2 * side + 1]));
            }
    }
}

}  // namespace nuvo
#endif
