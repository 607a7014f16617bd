// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_SHADOW_LOOKUP_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_SHADOW_LOOKUP_H_
#undef NUVO_RENDER_FAST_SHADOW_LOOKUP_H_
#else
#define NUVO_RENDER_FAST_SHADOW_LOOKUP_H_
#endif

#include <bit>
#include <limits>

#include "fast/light/counted_points.h"
#include "fast/light/light_cells.h"
#include "fast/shadow/shadow_block.h"
#include "fast/simd/lanes.h"
#include "fast/simd/prefetch.h"
#include "nuvo/math/error_bounds.h"

// A tile's points are looked up in a light's buffer step by step, each step for all of them: cells,
// lists, entries, items. So what a step reads is on its way from memory during the one before, and
// loops are long: the end of a short one is a branch that the processor foresees badly.

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

    /// Finds the cells of points of block b; returns which of these lanes can be looked up.
    HWY_INLINE std::uint32_t add(int b, std::uint32_t wanted) {
        if (!buffer_.usable() || wanted == 0) return 0;
        const ShadowBlock& block = blocks_[b];
        const LightPlaces places(buffer_.map, context_.table.light, block.points(), block.error());
        const std::uint32_t asked =
            counted_ == nullptr ? wanted : covered(*counted_, places, block.error(), wanted);
        const std::uint32_t good = asked & places.good;
        alignas(64) std::int32_t cell[16];
        for (const LightGrid& grid : buffer_.grids) {
            const auto [cells, windows] = places.cells(grid);
            cells.store(cell);
            for (std::uint32_t todo = good; todo != 0;) {
                const int lane = std::countr_zero(todo);
                std::uint32_t lanes = todo & (cells == Ints(cell[lane])).bits();
                todo ^= lanes;
                if (grid.sparse && lanes != good && (lanes | todo) == good) {
                    // The first of several cells.
                    const std::uint32_t rest = occupied(cells);
                    todo &= rest;
                    lanes &= rest;
                    if (lanes == 0) continue;
                }
                Visit& visit = add_visit(b, lanes, static_cast<std::uint32_t>(cell[lane]));
                const RayMask there = RayMask::from_bits(lanes);
                visit.window =
                    highest_bytes(select(mask_for<std::int32_t>(there), windows, Ints(0)));
                visit.depth = highest(select(there, places.depth, Floats(-kFloatInfinity)));
            }
        }
        const std::uint32_t rough = asked & places.known & ~places.good;
        return HWY_UNLIKELY(rough != 0) ? good | add_rough(b, places, rough) : good;
    }

    /// Tests all points that were added. Where lists begin with what blocks most, by rounds: their
    /// rest is left out where that has blocked all.
    void run() {
        for (int i = 0; i < visit_count_; ++i) find_list(visits_[i]);
        const std::uint32_t round =
            buffer_.near_first ? LightBuffer::kRound : std::numeric_limits<std::uint32_t>::max();
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
        std::uint32_t begin;  // its entries
        std::uint32_t end;
    };
    // The candidates of a visit end here.
    struct Run {
        int end;
        std::uint16_t block;
        std::uint16_t lanes;
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
        __builtin_prefetch(&buffer_.starts[cell]);
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

    HWY_INLINE void find_list(Visit& visit) const {
        visit.begin = buffer_.starts[visit.cell];
        visit.end = buffer_.starts[visit.cell + 1];
        prefetch(visit);
    }
    HWY_INLINE void prefetch(const Visit& visit) const {
        prefetch_lines(buffer_.group(visit.begin, visit.end).words,
                       LightGroup::kWords * LightGroup::kMost * sizeof(std::uint32_t));
    }
    // Looks at the next entries, up to `most`; false: nothing is left to be looked at.
    HWY_INLINE bool scan(Visit& visit, std::uint32_t most) {
        const ShadowBlock& block = blocks_[visit.block];
        if ((block.waiting() & visit.lanes) == 0) return false;
        const std::uint32_t end = visit.begin + std::min(most, visit.end - visit.begin);
        while (visit.begin < end) {
            const LightGroup group = buffer_.group(visit.begin, visit.end);
            visit.begin += group.count;
            candidate_count_ += static_cast<int>(
                Ints::load(group.places())
                    .compress_store(candidates_ + candidate_count_, meets(group, visit)));
            prefetch_next();
            if (candidate_count_ <= kMaxCandidates - static_cast<int>(LightGroup::kMost)) continue;
            end_run(visit);
            test_candidates();
            if ((block.waiting() & visit.lanes) == 0) return false;
        }
        end_run(visit);
        if (visit.begin >= visit.end) return false;
        if (std::bit_cast<float>(buffer_.group(visit.begin, visit.end).nears()[0]) > visit.depth)
            return false;
        prefetch(visit);
        return true;
    }
    // Which of a group may stand before the visiting points.
    static HWY_INLINE LaneMask<std::int32_t, 16> meets(const LightGroup& group,
                                                       const Visit& visit) {
        constexpr auto kAll = static_cast<std::int32_t>(CellBox::kMeets);
        const Ints boxes = Ints::load(group.boxes());
        const Ints left = Ints(static_cast<std::int32_t>(visit.window)) - boxes;
        const Floats nears = Floats::load(reinterpret_cast<const float*>(group.nears()));
        return ((left & Ints(kAll)) == Ints(kAll)) &
               mask_for<std::int32_t>((nears <= Floats(visit.depth)) &
                                      RayMask::from_bits((1U << group.count) - 1));
    }
    HWY_INLINE void end_run(const Visit& visit) {
        runs_[run_count_++] = {candidate_count_, visit.block, visit.lanes};
    }
    HWY_INLINE void prefetch_item(Slot place) const {
        const ShadowTable& table = context_.table;
        if (place < table.triangles)
            __builtin_prefetch(&table.planes[place]);
        else
            __builtin_prefetch(&context_.job.tables.quadric(table.slot(place)));
    }
    // As many for each group, some of them again: as many as it gave, the processor would not know.
    HWY_INLINE void prefetch_next() {
        constexpr int kAtOnce = 2;
        if (candidate_count_ == 0) return;
        for (int i = 0; i < kAtOnce; ++i)
            prefetch_item(candidates_[std::min(prefetched_ + i, candidate_count_ - 1)]);
        prefetched_ = std::min(prefetched_ + kAtOnce, candidate_count_);
    }
    HWY_INLINE void test_candidates() {
        while (prefetched_ < candidate_count_) prefetch_item(candidates_[prefetched_++]);
        prefetched_ = 0;
        int i = 0;
        for (int r = 0; r < run_count_; ++r) {
            const Run& run = runs_[r];
            ShadowBlock& block = blocks_[run.block];
            for (; i < run.end && (block.waiting() & run.lanes) != 0; ++i)
                block.test(context_, candidates_[i], run.lanes);
            i = run.end;
        }
        candidate_count_ = 0;
        run_count_ = 0;
    }

    const ShadowContext& context_;
    const LightBuffer& buffer_;
    const WantedDepths* counted_;  // null: the lists are for all points that are asked for
    ShadowBlock* blocks_;
    int visit_count_ = 0;
    int run_count_ = 0;
    int candidate_count_ = 0;
    int prefetched_ = 0;  // of the candidates
    Visit visits_[kMaxVisits];
    Run runs_[kMaxVisits];
    Slot candidates_[kMaxCandidates];  // places
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_SHADOW_LOOKUP_H_
