// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_SHADOW_LOOKUP_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_SHADOW_LOOKUP_H_
#undef NUVO_RENDER_FAST_SHADOW_LOOKUP_H_
#else
#define NUVO_RENDER_FAST_SHADOW_LOOKUP_H_
#endif

#include <hwy/cache_control.h>

#include <bit>
#include <cmath>
#include <limits>

#include "fast/light/counted_points.h"
#include "fast/light/light_cells.h"
#include "fast/shadow/shadow_block.h"
#include "fast/simd/lanes.h"

// A tile's points are looked up in a light's buffer step by step, each step for all of them: cells,
// lists, entries, items. So what a step reads is on its way from memory during the one before.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class ShadowLookup {
  public:
    ShadowLookup(const ShadowContext& context, ShadowBlock* blocks)
        : context_(context),
          buffer_(context.table.buffer),
          counted_(context.job.new_points && context.table.wanted ? &*context.table.wanted
                                                                  : nullptr),
          blocks_(blocks) {}

    /// Finds the cells of block b's points; returns which lanes can be looked up.
    HWY_INLINE std::uint32_t add(int b) {
        if (!buffer_.usable()) return 0;
        const ShadowBlock& block = blocks_[b];
        const LightPlaces places(buffer_.map, context_.table.light, block.points(), block.error());
        const std::uint32_t there =
            counted_ == nullptr ? block.waiting()
                                : covered(*counted_, places, block.error(), block.waiting());
        const std::uint32_t good = there & places.good;
        Stored stored;
        for (int i = 0; i < 2; ++i) places.step[i].store(stored.step[i]);
        places.depth.store(stored.depth);
        for (const LightGrid& grid : buffer_.grids) {
            const Ints cells = places.cells(grid);
            cells.store(stored.cell);
            for (std::uint32_t todo = good; todo != 0;) {
                const int lane = std::countr_zero(todo);
                std::uint32_t lanes = todo & (cells == Ints(stored.cell[lane])).bits();
                todo ^= lanes;
                if (grid.sparse && lanes != good && (lanes | todo) == good) {
                    // The first of several cells.
                    const std::uint32_t rest = occupied(cells);
                    todo &= rest;
                    lanes &= rest;
                    if (lanes == 0) continue;
                }
                Visit& visit = add_visit(b, lanes, static_cast<std::uint32_t>(stored.cell[lane]));
                if ((lanes & (lanes - 1)) == 0)
                    put_window(visit, grid, stored, lane);
                else
                    put_window(visit, grid, places, lanes);
            }
        }
        const std::uint32_t rough = there & places.known & ~places.good;
        return HWY_UNLIKELY(rough != 0) ? good | add_rough(b, places, rough) : good;
    }

    /// Tests all points that were added. Where lists begin with what blocks most, by rounds: their
    /// rest is left out where that has blocked all.
    void run() {
        for (int i = 0; i < visit_count_; ++i) find_list(visits_[i]);
        const std::uint32_t round =
            buffer_.near_first ? LightGroup::kMost : std::numeric_limits<std::uint32_t>::max();
        while (visit_count_ > 0) {
            int left = 0;
            for (int i = 0; i < visit_count_; ++i)
                if (scan(visits_[i], round)) visits_[left++] = visits_[i];
            test_candidates();
            visit_count_ = left;
        }
    }

  private:
    // Points of a block that are looked up in one cell, and the least window around them.
    struct Visit {
        std::uint32_t cell;
        std::uint16_t block;
        std::uint16_t lanes;
        std::uint32_t window;  // CellBox::window()
        float depth;
        Slot own;             // on which all the points lie, or kNoSlot
        std::uint32_t begin;  // its entries
        std::uint32_t end;
    };
    struct Candidate {
        Slot place;
        std::uint16_t block;
        std::uint16_t lanes;
    };
    struct Stored {
        alignas(64) float step[2][16];
        alignas(64) float depth[16];
        alignas(64) std::int32_t cell[16];
    };
    static constexpr int kMaxVisits = 512;
    static constexpr int kMaxCandidates = 256;

    HWY_INLINE std::uint32_t occupied(const Ints& cells) const {
        const Ints words = Ints::gather(buffer_.occupied.data(), cells >> Ints(5));
        return ((words >> (cells & Ints(31)) & Ints(1)) != Ints(0)).bits();
    }
    HWY_INLINE Visit& add_visit(int b, std::uint32_t lanes, std::uint32_t cell) {
        if (HWY_UNLIKELY(visit_count_ == kMaxVisits)) run();
        Visit& visit = visits_[visit_count_++];
        visit.cell = cell;
        visit.block = static_cast<std::uint16_t>(b);
        visit.lanes = static_cast<std::uint16_t>(lanes);
        visit.own = blocks_[b].common(lanes);
        hwy::Prefetch(&buffer_.starts[cell]);
        return visit;
    }

    // Points that are known less well are looked up in all cells where they may be, if these are
    // few.
    HWY_NOINLINE std::uint32_t add_rough(int b, const LightPlaces& places, std::uint32_t lanes) {
        constexpr std::uint32_t kFew = 16;
        const Floats& error = blocks_[b].error();
        const Floats& moved = places.moved;
        Rough rough;
        RayMask on_face = moved >= Floats(0.0F);
        for (int i = 0; i < 2; ++i) {
            integers_from(step_of(buffer_.map, i, places.u[i] - moved))
                .store(reinterpret_cast<std::int32_t*>(rough.low[i]));
            integers_from(step_of(buffer_.map, i, places.u[i] + moved))
                .store(reinterpret_cast<std::int32_t*>(rough.high[i]));
            if (buffer_.map.inside) on_face = on_face & (abs(places.u[i]) + moved < Floats(1.0F));
        }
        (places.depth + error).store(rough.depth);
        places.face.store(rough.face);
        std::uint32_t added = 0;
        for (lanes &= on_face.bits(); lanes != 0; lanes &= lanes - 1) {
            const int lane = std::countr_zero(lanes);
            // On coarser grids they are fewer.
            if (cell_count(rough.steps(lane, buffer_.grids.front())) > kFew) continue;
            added |= 1U << lane;
            for (const LightGrid& grid : buffer_.grids) add_rough(b, rough, lane, grid);
        }
        return added;
    }
    struct Rough {
        alignas(64) std::uint32_t low[2][16];
        alignas(64) std::uint32_t high[2][16];
        alignas(64) std::int32_t face[16];
        alignas(64) float depth[16];

        CellSteps steps(int lane, const LightGrid& grid) const {
            return {grid, {low[0][lane], low[1][lane]}, {high[0][lane], high[1][lane]}};
        }
    };
    static std::uint32_t cell_count(const CellSteps& steps) {
        return (steps.last_cell(0) - steps.first_cell(0) + 1) *
               (steps.last_cell(1) - steps.first_cell(1) + 1);
    }
    void add_rough(int b, const Rough& rough, int lane, const LightGrid& grid) {
        const CellSteps steps = rough.steps(lane, grid);
        const auto columns = static_cast<std::uint32_t>(grid.columns);
        const auto first_row = static_cast<std::uint32_t>(rough.face[lane] * grid.rows);
        for (std::uint32_t row = steps.first_cell(1); row <= steps.last_cell(1); ++row)
            for (std::uint32_t column = steps.first_cell(0); column <= steps.last_cell(0);
                 ++column) {
                const std::uint32_t cell = (first_row + row) * columns + column;
                Visit& visit = add_visit(b, 1U << lane, grid.first_cell + cell);
                visit.window = steps.in(column, row).window();
                visit.depth = rough.depth[lane];
            }
    }

    // The window of steps in the cell where they are.
    static std::uint32_t window_of(const LightGrid& grid, const std::uint32_t (&first)[2],
                                   const std::uint32_t (&last)[2]) {
        const CellSteps steps(grid, first, last);
        return steps.in(steps.first_cell(0), steps.first_cell(1)).window();
    }
    static HWY_INLINE void put_window(Visit& visit, const LightGrid& grid, const Stored& stored,
                                      int lane) {
        const std::uint32_t at[2] = {static_cast<std::uint32_t>(stored.step[0][lane]),
                                     static_cast<std::uint32_t>(stored.step[1][lane])};
        visit.window = window_of(grid, at, at);
        visit.depth = stored.depth[lane];
    }
    static HWY_INLINE void put_window(Visit& visit, const LightGrid& grid,
                                      const LightPlaces& places, std::uint32_t lanes) {
        const RayMask there = RayMask::from_bits(lanes);
        std::uint32_t first[2];
        std::uint32_t last[2];
        for (int i = 0; i < 2; ++i) {
            const Floats& step = places.step[i];
            first[i] = static_cast<std::uint32_t>(lowest(select(there, step, Floats(kLightSteps))));
            last[i] = static_cast<std::uint32_t>(highest(select(there, step, Floats(0.0F))));
        }
        visit.window = window_of(grid, first, last);
        visit.depth =
            highest(select(there, places.depth, Floats(-std::numeric_limits<float>::infinity())));
    }

    HWY_INLINE void find_list(Visit& visit) const {
        visit.begin = buffer_.starts[visit.cell];
        visit.end = buffer_.starts[visit.cell + 1];
        prefetch(visit);
    }
    HWY_INLINE void prefetch(const Visit& visit) const {
        constexpr std::size_t kLine = 64 / sizeof(std::uint32_t);
        const LightGroup group = buffer_.group(visit.begin, visit.end);
        for (std::size_t at = 0; at < LightGroup::kWords * LightGroup::kMost; at += kLine)
            hwy::Prefetch(group.words + at);
    }
    // Looks at the next entries, up to `most`; false: nothing is left to be looked at.
    HWY_INLINE bool scan(Visit& visit, std::uint32_t most) {
        const ShadowTable& table = context_.table;
        const ShadowBlock& block = blocks_[visit.block];
        if ((block.waiting() & visit.lanes) == 0) return false;
        const std::uint32_t end = visit.begin + std::min(most, visit.end - visit.begin);
        while (visit.begin < end) {
            const LightGroup group = buffer_.group(visit.begin, visit.end);
            visit.begin += group.count;
            for (std::uint32_t found = meets(group, visit); found != 0; found &= found - 1) {
                const Slot place = group.places()[std::countr_zero(found)];
                if (place < table.triangles) {
                    if (table.slot(place) == visit.own) continue;  // it does not hide itself
                    hwy::Prefetch(&table.planes[place]);
                } else {
                    hwy::Prefetch(&context_.job.tables.quadric(table.slot(place)));
                }
                candidates_[candidate_count_++] = {place, visit.block, visit.lanes};
            }
            if (candidate_count_ <= kMaxCandidates - static_cast<int>(LightGroup::kMost)) continue;
            test_candidates();
            if ((block.waiting() & visit.lanes) == 0) return false;
        }
        if (visit.begin >= visit.end) return false;
        if (std::bit_cast<float>(buffer_.group(visit.begin, visit.end).nears()[0]) > visit.depth)
            return false;
        prefetch(visit);
        return true;
    }
    // Which of a group may stand before the visiting points.
    static HWY_INLINE std::uint32_t meets(const LightGroup& group, const Visit& visit) {
        constexpr auto kAll = static_cast<std::int32_t>(CellBox::kMeets);
        const Ints boxes = Ints::load(reinterpret_cast<const std::int32_t*>(group.boxes()));
        const Ints left = Ints(static_cast<std::int32_t>(visit.window)) - boxes;
        const Floats nears = Floats::load(reinterpret_cast<const float*>(group.nears()));
        return ((left & Ints(kAll)) == Ints(kAll)).bits() & (nears <= Floats(visit.depth)).bits() &
               ((1U << group.count) - 1);
    }
    HWY_INLINE void test_candidates() {
        for (int i = 0; i < candidate_count_; ++i) {
            const Candidate& candidate = candidates_[i];
            ShadowBlock& block = blocks_[candidate.block];
            if ((block.waiting() & candidate.lanes) != 0)
                block.test(context_, candidate.place, candidate.lanes);
        }
        candidate_count_ = 0;
    }

    const ShadowContext& context_;
    const LightBuffer& buffer_;
    const WantedDepths* counted_;  // null: the lists are for all points that are asked for
    ShadowBlock* blocks_;
    int visit_count_ = 0;
    int candidate_count_ = 0;
    Visit visits_[kMaxVisits];
    Candidate candidates_[kMaxCandidates];
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_SHADOW_LOOKUP_H_
