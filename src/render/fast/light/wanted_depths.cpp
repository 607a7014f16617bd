#include "fast/light/wanted_depths.h"

#include <algorithm>
#include <atomic>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/light/wanted_depths.cpp"
#include <hwy/foreach_target.h>

#include "fast/light/light_cells.h"
#include "fast/light/light_ranges.h"
#include "fast/simd/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

bool start_map(const LightPoint& light, const FastScene& scene, LightMap& map, float (&extent)[2]) {
    ItemRanges ranges;
    return ranges.start(light, scene, map, extent);
}

HWY_INLINE Points points_of(const Tile& tile, int b) {
    const int first = b * kBlockLanes;
    return {Floats::load(tile.point[0] + first), Floats::load(tile.point[1] + first),
            Floats::load(tile.point[2] + first)};
}

// Adds the points of a block: wherever they may be, as deep as they may be.
class WantedAdder {
  public:
    WantedAdder(const LightMap& map, const LightPoint& light, const WantedDepths::Cells& cells)
        : map_(map), light_(light), cells_(cells) {}

    HWY_INLINE void add(const Points& points, const Floats& error, std::uint32_t lanes) {
        const LightPlaces places(map_, light_, points, error);
        lanes &= places.known;
        if (lanes == 0) return;
        Ints first[2];
        Ints last[2];
        for (int i = 0; i < 2; ++i) {
            first[i] = cell(step_of(map_, i, places.u[i] - places.moved));
            last[i] = cell(step_of(map_, i, places.u[i] + places.moved));
        }
        const Floats depth = places.depth + error;
        const Ints row = places.face * Ints(cells_.side);
        const Ints at = (row + first[1]) * Ints(cells_.side) + first[0];
        const std::uint32_t single = ((first[0] == last[0]) & (first[1] == last[1])).bits();
        alignas(64) std::int32_t place[kBlockLanes];
        at.store(place);
        for (std::uint32_t todo = lanes & single; todo != 0;) {
            const std::int32_t here = place[std::countr_zero(todo)];
            const std::uint32_t same = todo & (at == Ints(here)).bits();
            todo ^= same;
            deepen(here, highest(select(RayMask::from_bits(same), depth, Floats(-kInfinity))));
        }
        if (const std::uint32_t spread = lanes & ~single; HWY_UNLIKELY(spread != 0))
            add_spread(first, last, row, depth, spread);
    }

  private:
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();

    HWY_INLINE Ints cell(const Floats& step) const {
        return integers_from(step) >> Ints(cells_.step_bits);
    }
    HWY_NOINLINE void add_spread(const Ints (&first)[2], const Ints (&last)[2], const Ints& row,
                                 const Floats& depth, std::uint32_t lanes) {
        alignas(64) std::int32_t low[2][kBlockLanes];
        alignas(64) std::int32_t high[2][kBlockLanes];
        alignas(64) std::int32_t rows[kBlockLanes];
        alignas(64) float depths[kBlockLanes];
        for (int i = 0; i < 2; ++i) {
            first[i].store(low[i]);
            last[i].store(high[i]);
        }
        row.store(rows);
        depth.store(depths);
        for (; lanes != 0; lanes &= lanes - 1) {
            const int lane = std::countr_zero(lanes);
            for (std::int32_t y = low[1][lane]; y <= high[1][lane]; ++y)
                for (std::int32_t x = low[0][lane]; x <= high[0][lane]; ++x)
                    deepen((rows[lane] + y) * cells_.side + x, depths[lane]);
        }
    }
    HWY_INLINE void deepen(std::int32_t place, float depth) {
        const std::atomic_ref<float> cell(cells_.depth[place]);
        float before = cell.load(std::memory_order_relaxed);
        while (before < depth &&
               !cell.compare_exchange_weak(before, depth, std::memory_order_relaxed)) {
        }
    }

    const LightMap& map_;
    const LightPoint& light_;
    const WantedDepths::Cells& cells_;
};

void add_points(const LightMap& map, const LightPoint& light, const WantedDepths::Cells& cells,
                const Tile& tile, const TileMask& wanted) {
    WantedAdder adder(map, light, cells);
    for (int b = 0; b < kTileBlocks; ++b)
        if (wanted[b] != 0)
            adder.add(points_of(tile, b), Floats::load(tile.point_error + b * kBlockLanes),
                      wanted[b]);
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
    map.most_moved =
        kMostCells * std::min(extent[0], extent[1]) / static_cast<float>(out.cells_a_side_);
    std::size_t size = 0;
    for (int side = out.cells_a_side_; side > 0; side /= 2) {
        out.level_starts_.push_back(size);
        size += static_cast<std::size_t>(map.faces() * side * side);
    }
    out.cells_.resize(size);
    std::fill(out.cells_.begin(), out.cells_.end(), -std::numeric_limits<float>::infinity());
    return out;
}

void WantedDepths::add(const Tile& tile, const TileMask& wanted) {
    const Cells cells{cells_.data(), cells_a_side_, step_bits_};
    (NUVO_FOR_ISA(isa_, add_points))(map_, light_, cells, tile, wanted);
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
