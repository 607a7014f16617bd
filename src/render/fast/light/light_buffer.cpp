#include "fast/light/light_buffer.h"

#include <algorithm>
#include <bit>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/light/light_buffer.cpp"
#include <hwy/foreach_target.h>

#include "fast/light/light_cells.h"
#include "fast/light/light_ranges.h"

// Items are sorted into cells by counting. The middle of a sample tells how large they are; most
// then cover few cells of the finest grid.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

alignas(64) constexpr std::int32_t kLaneNumbers[16] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                       8, 9, 10, 11, 12, 13, 14, 15};

class LightBufferMaker {
  public:
    LightBufferMaker(LightBuffer& out, const LightPoint& light, const LightItems& items)
        : out_(out), items_(items), triangle_end_(items.triangles()), end_(items.size()) {
        if (!ranges_.start(light, items.scene, out.map, extent_)) return;
        faces_ = out.map.faces();
        ranges_.allow(kLeastError * out_.map.point_size, items_.touch, out_.map);
    }

    void run() {
        if (faces_ == 0) return;
        choose_grids();
        out_.starts.resize(cells_ + 1);
        std::fill(out_.starts.begin(), out_.starts.end(), 0);
        records_.resize(end_ + end_ / 2 + 16);  // some are seen through several faces
        for (Slot first = 0; first < end_; first += count_from(first)) {
            for (Slot i = first + 16; items_.slots.list && i < std::min<Slot>(first + 32, end_);
                 ++i)
                prefetch_corners(items_, items_.slot(i));
            for_each_face(first, [&](int face, const LightRanges& ranges, std::uint32_t lanes)
                                     HWY_ATTR { record(first, face, ranges, lanes); });
        }
        add_up();
        fill();
    }

  private:
    // Cells of a grid are so many times as wide as those of the finer one, and an item that covers
    // more cells than a cell of the coarser grid does belongs there.
    static constexpr int kCoarser = 8;
    // Cells of the finest grid have few items, but are not much smaller than the middle one, which
    // would be listed often.
    static constexpr double kMostItems = 32;
    static constexpr double kMostWide = 4.5;
    static constexpr double kLeastWide = 0.75;
    // Cells for each item on all faces: they have to be counted and added up.
    static constexpr double kMostCells = 2;
    // Where an entry's list is longer than these on average, lists are sorted, or long.
    static constexpr double kListsToSort = 128;
    static constexpr double kLongLists = 4096;

    // What points may be off, in the size of the middle item, and in that of points.
    static constexpr double kErrorShare = 0x1p-4;
    static constexpr double kLeastError = 0x1p-20;

    // What is known of an item on a face.
    struct Item {
        Slot place;
        float near;
        std::uint16_t low[2];  // steps between which it lies
        std::uint16_t high[2];
    };
    static_assert(sizeof(Item) == 16);
    // The cells that it covers on its grid: at most kCoarser^2 but for the last grid, which has
    // only one.
    struct Record {
        Item item;
        std::uint32_t first;
        std::uint8_t columns;
        std::uint8_t rows;
        std::uint8_t grid;
    };
    // The same for 16 items.
    struct Cells {
        HWY_INLINE Cells(const LightGrid& grid, int face, const Ints (&low)[2],
                         const Ints (&high)[2]) {
            const Ints column = cell_of(low[0], grid.columns);
            const Ints row = cell_of(low[1], grid.rows);
            const auto base =
                static_cast<std::int32_t>(grid.first_cell) + face * grid.rows * grid.columns;
            (column + row * Ints(grid.columns) + Ints(base)).store(first);
            (cell_of(high[0], grid.columns) - column + Ints(1)).store(columns);
            (cell_of(high[1], grid.rows) - row + Ints(1)).store(rows);
        }
        bool few(int i) const { return columns[i] * rows[i] <= kCoarser * kCoarser; }

        alignas(64) std::int32_t first[16];
        alignas(64) std::int32_t columns[16];
        alignas(64) std::int32_t rows[16];
    };

    struct Entry {
        std::uint32_t word[LightGroup::kWords];
    };

    /// Calls use(face, ranges, lanes) for the faces on which items [first, first + 16) are met.
    template <typename Use>
    HWY_INLINE void for_each_face(Slot first, Use&& use) {
        const Slot count = count_from(first);
        const std::uint32_t there = ((1U << count) - 1) & hiding(first);
        if (there == 0) return;
        ranges_.for_each_face(
            corners_of(items_, count, [&](Slot i) { return items_.slot(first + i); }), there, use);
    }
    // Which of 16 items from `first` on may hide something.
    std::uint32_t hiding(Slot first) const {
        if (first >= triangle_end_ || items_.hides == nullptr) return ~0U;
        const std::uint8_t* const at = items_.hides + first / 8;
        return (std::uint32_t{at[0]} | std::uint32_t{at[1]} << 8 | std::uint32_t{at[2]} << 16) >>
               first % 8;
    }
    // At most 16, of one kind.
    Slot count_from(Slot first) const {
        return std::min<Slot>(16, (first < triangle_end_ ? triangle_end_ : end_) - first);
    }
    void choose_grids() {
        const double size = sample();
        for (int i = 0; i < 2; ++i)
            out_.map.steps[i] = static_cast<float>(kLightSteps) / extent_[i];
        const double items = std::max<double>(end_, 1);
        const double least =
            std::sqrt(static_cast<double>(extent_[0]) * extent_[1] * faces_ / (kMostCells * items));
        const double fine =
            std::sqrt(static_cast<double>(extent_[0]) * extent_[1] * faces_ * kMostItems / items);
        double width = std::max({std::min(kMostWide * size, fine), kLeastWide * size, least});
        while (out_.grids.empty() || cells_of(out_.grids.back()) > 1) {
            const bool last = out_.grids.size() + 1 == LightBuffer::kMaxGrids;
            const auto count = [&](int i) {
                return last ? 1 : static_cast<int>(std::clamp(extent_[i] / width, 1.0, 8192.0));
            };
            out_.grids.push_back({count(0), count(1), cells_});
            cells_ += cells_of(out_.grids.back());
            if (last) break;
            width *= kCoarser;
        }
    }
    std::uint32_t cells_of(const LightGrid& grid) const {
        return static_cast<std::uint32_t>(faces_ * grid.columns * grid.rows);
    }
    // Goes by some of the items: how large they are tells how far points may be off. Where most of
    // them keep to a small part of the grid, that becomes the grid, and its border stands for the
    // rest. Returns the middle size of an item, on the longer of both axes.
    double sample() {
        constexpr Slot kBatches = 64;
        std::vector<float> sizes;
        std::vector<float> lengths;  // before they were projected
        std::vector<float> centers[2];
        for (Slot i = 0; i < kBatches; ++i) {
            const auto first = static_cast<Slot>(std::uint64_t{end_} * i / kBatches);
            for_each_face(first, [&](int, const LightRanges& ranges, std::uint32_t lanes) {
                alignas(64) float size[16];
                alignas(64) float length[16];
                alignas(64) float center[2][16];
                const Floats larger =
                    max(ranges.high[0] - ranges.low[0], ranges.high[1] - ranges.low[1]);
                larger.store(size);
                (out_.map.inside ? larger * ranges.near : larger).store(length);
                for (int k = 0; k < 2; ++k)
                    ((ranges.high[k] + ranges.low[k]) * Floats(0.5F)).store(center[k]);
                for (; lanes != 0; lanes &= lanes - 1) {
                    const int lane = std::countr_zero(lanes);
                    sizes.push_back(size[lane]);
                    lengths.push_back(length[lane]);
                    for (int k = 0; k < 2; ++k) centers[k].push_back(center[k][lane]);
                }
            });
        }
        for (int k = 0; k < 2; ++k) narrow(k, centers[k]);
        if (sizes.empty()) return extent_[0];
        const double size = out_.map.point_size;
        ranges_.allow(std::clamp(quantile(lengths, 0.5) * kErrorShare, kLeastError * size,
                                 kMostPointError * size),
                      items_.touch, out_.map);
        return quantile(sizes, 0.5);
    }
    void narrow(int k, std::vector<float>& centers) {
        constexpr double kMuch = 4;
        constexpr double kLeastShare = 0x1p-60;
        if (centers.empty()) return;
        const double low = quantile(centers, 0.02);
        const double high = quantile(centers, 0.98);
        const double width = 1.5 * (high - low);
        if (!(kMuch * width < extent_[k]) || width < kLeastShare * extent_[k]) return;
        out_.map.low[k] = static_cast<float>(low - 0.25 * (high - low));
        extent_[k] = static_cast<float>(width);
    }
    static double quantile(std::vector<float>& v, double share) {
        const auto at =
            v.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(v.size() - 1));
        std::nth_element(v.begin(), at, v.end());
        return *at;
    }

    HWY_INLINE void record(Slot first, int face, const LightRanges& ranges, std::uint32_t lanes) {
        Ints low[2];
        Ints high[2];
        alignas(64) Item items[16];
        for (int i = 0; i < 2; ++i) {
            low[i] = integers_from(step_of(out_.map, i, ranges.low[i]));
            high[i] = integers_from(step_of(out_.map, i, ranges.high[i]));
        }
        const auto pair = [](const Ints(&v)[2]) { return v[0] | shift_left<16>(v[1]); };
        const Ints slots = Ints(static_cast<std::int32_t>(first)) + Ints::load(kLaneNumbers);
        store_by_fours(slots, bits_of(ranges.near), pair(low), pair(high),
                       reinterpret_cast<std::int32_t*>(items));
        if (used_ + 16 > records_.size()) records_.resize(2 * records_.size() + 16);
        for (std::size_t g = 0; lanes != 0; ++g) {
            const Cells cells(out_.grids[g], face, low, high);
            std::uint32_t left = 0;
            for (; lanes != 0; lanes &= lanes - 1) {
                const int i = std::countr_zero(lanes);
                if (!cells.few(i)) {
                    left |= lanes & -lanes;
                    continue;
                }
                Record& record = records_[used_++];
                record = {items[i], static_cast<std::uint32_t>(cells.first[i]),
                          static_cast<std::uint8_t>(cells.columns[i]),
                          static_cast<std::uint8_t>(cells.rows[i]), static_cast<std::uint8_t>(g)};
                for_each_cell(record, [&](std::uint32_t cell, std::uint32_t, std::uint32_t) {
                    ++out_.starts[cell + 1];
                });
            }
            lanes = left;
        }
    }
    template <typename Use>
    HWY_INLINE void for_each_cell(const Record& record, Use&& use) const {
        const auto columns = static_cast<std::uint32_t>(out_.grids[record.grid].columns);
        std::uint32_t first = record.first;
        for (std::uint32_t y = 0; y < record.rows; ++y, first += columns)
            for (std::uint32_t x = 0; x < record.columns; ++x) use(first + x, x, y);
    }

    // Makes starts[c] the start of cell c. In lists that are not short what is near the light comes
    // first: it blocks most.
    void add_up() {
        double squares = 0;
        for (std::size_t cell = 0; cell < cells_; ++cell) {
            const double length = out_.starts[cell + 1];
            squares += length * length;
            out_.starts[cell + 1] += out_.starts[cell];
        }
        const double entries = out_.starts[cells_];
        out_.near_first = squares > kListsToSort * entries;
        out_.long_lists = squares > kLongLists * entries;
    }
    void fill() {
        out_.entries.resize(LightGroup::kWords *
                            (std::size_t{out_.starts[cells_]} + LightGroup::kMost));
        next_.assign(out_.starts.begin(), out_.starts.end() - 1);
        std::for_each_n(records_.begin(), used_,
                        [&](const Record& record) HWY_ATTR { list(record); });
        if (out_.near_first)
            for (std::size_t cell = 0; cell < cells_; ++cell) sort(cell);
        const LightGrid coarsest = out_.grids.back();
        std::erase_if(out_.grids, [&](const LightGrid& grid) {
            return out_.starts[grid.first_cell] == out_.starts[grid.first_cell + cells_of(grid)];
        });
        if (out_.grids.empty()) out_.grids.push_back(coarsest);  // nothing hides anything
        for (LightGrid& grid : out_.grids) find_empty_cells(grid);
    }
    HWY_INLINE void list(const Record& record) {
        const Item& item = record.item;
        const CellSteps steps(out_.grids[record.grid], {item.low[0], item.low[1]},
                              {item.high[0], item.high[1]});
        for_each_cell(record, [&](std::uint32_t cell, std::uint32_t x, std::uint32_t y) {
            const std::uint32_t number = next_[cell]++ - out_.starts[cell];
            const std::uint32_t in_group = number % LightGroup::kMost;
            const std::uint32_t group = out_.starts[cell] + number - in_group;
            const std::size_t count = out_.group(group, out_.starts[cell + 1]).count;
            std::uint32_t* const words =
                out_.entries.data() + LightGroup::kWords * std::size_t{group} + in_group;
            words[0] = steps.in(steps.first_cell(0) + x, steps.first_cell(1) + y).item();
            words[count] = std::bit_cast<std::uint32_t>(item.near);
            words[2 * count] = item.place;
        });
    }
    // Puts first what is near the light, where a list is longer than what is looked at in any case.
    void sort(std::size_t cell) {
        const std::uint32_t begin = out_.starts[cell];
        const std::uint32_t end = out_.starts[cell + 1];
        if (end - begin <= LightBuffer::kRound) return;
        sorted_.resize(end - begin);
        const auto for_each_word = [&](auto&& use) {
            for (std::uint32_t at = begin; at < end; at += LightGroup::kMost) {
                const std::uint32_t count = out_.group(at, end).count;
                std::uint32_t* word = out_.entries.data() + LightGroup::kWords * std::size_t{at};
                for (std::size_t k = 0; k < LightGroup::kWords; ++k)
                    for (std::uint32_t i = 0; i < count; ++i)
                        use(*word++, sorted_[at - begin + i].word[k]);
            }
        };
        for_each_word([](std::uint32_t listed, std::uint32_t& word) { word = listed; });
        std::sort(sorted_.begin(), sorted_.end(), [](const Entry& a, const Entry& b) {
            return std::bit_cast<float>(a.word[1]) < std::bit_cast<float>(b.word[1]);
        });
        for_each_word([](std::uint32_t& listed, std::uint32_t word) { listed = word; });
    }
    // Points in several cells look at no list of empty ones; that does not pay where few are empty.
    void find_empty_cells(LightGrid& grid) {
        constexpr std::uint32_t kCells = 32;  // a word
        out_.occupied.resize(cells_ / kCells + 1);
        const std::uint32_t end = grid.first_cell + cells_of(grid);
        std::uint32_t occupied = 0;
        for (std::uint32_t cell = grid.first_cell; cell < end; ++cell) {
            const std::uint32_t lists = out_.starts[cell] != out_.starts[cell + 1] ? 1 : 0;
            const std::uint32_t bit = cell % kCells;
            std::int32_t& word = out_.occupied[cell / kCells];
            word = static_cast<std::int32_t>((static_cast<std::uint32_t>(word) & ~(1U << bit)) |
                                             lists << bit);
            occupied += lists;
        }
        grid.sparse = 2 * occupied < end - grid.first_cell;
    }

    LightBuffer& out_;
    const LightItems& items_;
    Slot triangle_end_;  // places
    Slot end_;
    ItemRanges ranges_;
    float extent_[2] = {};  // of u and v
    int faces_ = 0;
    std::uint32_t cells_ = 0;  // of all grids
    BigVector<Record> records_;
    BigVector<std::uint32_t> next_;  // of each cell: where its next entry goes
    std::size_t used_ = 0;
    std::vector<Entry> sorted_;  // a list's
};

void make_light_buffer(LightBuffer& out, const LightPoint& light, const LightItems& items) {
    LightBufferMaker(out, light, items).run();
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"

namespace nuvo {

LightBuffer::LightBuffer(const LightPoint& light, const LightItems& items, InstructionSet isa) {
    (NUVO_FOR_ISA(isa, make_light_buffer))(*this, light, items);
}

}  // namespace nuvo
#endif
