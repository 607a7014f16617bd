#include "fast/light_buffer.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/light_buffer.cpp"
#include <hwy/foreach_target.h>

#include "fast/light_cells.h"
#include "fast/light_ranges.h"

// Items are sorted into cells by counting. The middle of a sample tells how large they are; most
// then cover few cells of the finest grid.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class LightBufferMaker {
  public:
    LightBufferMaker(LightBuffer& out, const LightPoint& light, const LightBuffer::Source& source)
        : out_(out),
          source_(source),
          triangle_end_(source.scene.triangle_end()),
          end_(source.scene.slot_end()) {
        if (!light.finite || !(source.reach < 1.5) || end_ == 0) return;
        if (!plane_.start(light, source, out, extent_)) cube_.start(light, source, out, extent_);
        faces_ = out.inside ? 6 : 1;
        for (int i = 0; i < 2; ++i) out.steps[i] = static_cast<float>(kLightSteps) / extent_[i];
    }

    void run() {
        if (faces_ == 0) return;
        choose_grids();
        out_.starts.resize(cells_ + 2);
        std::fill(out_.starts.begin(), out_.starts.end(), 0);
        records_.resize(end_);
        for (Slot first = 0; first < end_; first += count_from(first))
            for_each_face(first, [&](int face, const LightRanges& ranges, std::uint32_t lanes)
                                     HWY_ATTR { record(first, face, ranges, lanes); });
        if (add_up()) fill();
    }

  private:
    // Cells of a grid are so many times as wide as those of the finer one, and an item that covers
    // more cells than a cell of the coarser grid does belongs there.
    static constexpr int kCoarser = 8;
    // In the size of the middle item: what a cell lists too much is cheap to tell.
    static constexpr double kCellSize = 3;
    // Cells for each item on all faces: they have to be counted and added up.
    static constexpr double kMostCells = 2;
    // Where an entry's list is longer than this on average the octree is faster.
    static constexpr double kLongLists = 512;

    struct Record {
        LightEntry entry;
        std::uint8_t grid;
        std::uint8_t face;
    };

    /// Calls use(face, ranges, lanes) for the faces on which items [first, first + 16) are met.
    template <typename Use>
    HWY_INLINE void for_each_face(Slot first, Use&& use) {
        const std::uint32_t there = (1U << count_from(first)) - 1;
        const ItemCorners items = corners(first);
        if (!out_.inside) {
            use(0, plane_.of(items), there);
            return;
        }
        cube_.take(items);
        for (int face = 0; face < 6; ++face) {
            const LightRanges ranges = cube_.of(face);
            if ((ranges.lanes & there) != 0) use(face, ranges, ranges.lanes & there);
        }
    }
    // At most 16, of one kind.
    Slot count_from(Slot first) const {
        return std::min<Slot>(16, (first < triangle_end_ ? triangle_end_ : end_) - first);
    }
    HWY_INLINE ItemCorners corners(Slot first) const {
        ItemCorners out;
        const Slot last = first + count_from(first) - 1;
        alignas(64) float at[3][3][16];
        for (Slot i = 0; i < 16; ++i) {
            const Slot slot = std::min(first + i, last);
            if (first < triangle_end_) {
                const LocalTriangle& t = source_.scene.triangles()[slot];
                for (int corner = 0; corner < 3; ++corner)
                    for (int axis = 0; axis < 3; ++axis)
                        at[corner][axis][i] = t.corner[corner][axis];
            } else {
                const RoundShape& shape = source_.rounds[slot - triangle_end_];
                for (int axis = 0; axis < 3; ++axis) {
                    at[0][axis][i] = shape.center[axis] - shape.radius;
                    at[1][axis][i] = shape.center[axis] + shape.radius;
                }
            }
        }
        out.count = first < triangle_end_ ? 3 : 2;
        for (int corner = 0; corner < out.count; ++corner)
            for (int axis = 0; axis < 3; ++axis)
                out.at[corner][axis] = Floats::load(at[corner][axis]);
        return out;
    }

    void choose_grids() {
        const double least =
            std::sqrt(static_cast<double>(extent_[0]) * extent_[1] * faces_ / (kMostCells * end_));
        for (double size = std::fmax(kCellSize * middle_size(), least);; size *= kCoarser) {
            const auto count = [&](int i) {
                return static_cast<int>(std::clamp(extent_[i] / size, 1.0, 8192.0));
            };
            out_.grids.push_back({count(0), count(1), cells_});
            cells_ += cells_of(out_.grids.back());
            if (out_.grids.size() == LightBuffer::kMaxGrids || cells_of(out_.grids.back()) == 1)
                break;
        }
    }
    std::uint32_t cells_of(const LightGrid& grid) const {
        return static_cast<std::uint32_t>(faces_ * grid.columns * grid.rows);
    }
    // On the longer of both axes.
    double middle_size() {
        constexpr Slot kBatches = 64;
        std::vector<float> sizes;
        for (Slot i = 0; i < kBatches; ++i) {
            const auto first = static_cast<Slot>(std::uint64_t{end_} * i / kBatches);
            for_each_face(first, [&](int, const LightRanges& ranges, std::uint32_t lanes) {
                alignas(64) float size[16];
                max(ranges.high[0] - ranges.low[0], ranges.high[1] - ranges.low[1]).store(size);
                for (; lanes != 0; lanes &= lanes - 1)
                    sizes.push_back(size[std::countr_zero(lanes)]);
            });
        }
        if (sizes.empty()) return extent_[0];
        const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
        std::nth_element(sizes.begin(), middle, sizes.end());
        return *middle;
    }

    HWY_INLINE void record(Slot first, int face, const LightRanges& ranges, std::uint32_t lanes) {
        alignas(64) std::int32_t low[2][16];
        alignas(64) std::int32_t high[2][16];
        alignas(64) float near[16];
        ranges.near.store(near);
        for (int i = 0; i < 2; ++i) {
            integers_from(step_of(out_, i, ranges.low[i])).store(low[i]);
            integers_from(step_of(out_, i, ranges.high[i])).store(high[i]);
        }
        if (used_ + 16 > records_.size()) records_.resize(2 * records_.size() + 16);
        for (; lanes != 0; lanes &= lanes - 1) {
            const int i = std::countr_zero(lanes);
            Record& record = records_[used_++];
            record.entry.slot = first + static_cast<Slot>(i);
            record.entry.near = near[i];
            for (int k = 0; k < 2; ++k) {
                record.entry.low[k] = static_cast<std::uint16_t>(low[k][i]);
                record.entry.high[k] = static_cast<std::uint16_t>(high[k][i]);
            }
            record.face = static_cast<std::uint8_t>(face);
            count(record);
        }
    }

    // The cells that an item covers on a grid.
    struct Cells {
        std::uint32_t first;
        std::uint32_t columns;
        std::uint32_t rows;
    };
    Cells cells(const Record& record, const LightGrid& grid) const {
        const auto at = [](std::uint32_t step, int count) {
            return step * static_cast<std::uint32_t>(count) / kLightSteps;
        };
        const LightEntry& e = record.entry;
        const std::uint32_t column = at(e.low[0], grid.columns);
        const std::uint32_t row = at(e.low[1], grid.rows);
        const auto above = static_cast<std::uint32_t>(record.face * grid.rows);
        return {grid.first_cell + (above + row) * static_cast<std::uint32_t>(grid.columns) + column,
                at(e.high[0], grid.columns) - column + 1, at(e.high[1], grid.rows) - row + 1};
    }
    template <typename Use>
    void for_each_cell(const Cells& cells, const LightGrid& grid, Use&& use) const {
        std::uint32_t first = cells.first;
        for (std::uint32_t y = 0; y < cells.rows; ++y) {
            for (std::uint32_t x = 0; x < cells.columns; ++x) use(first + x);
            first += static_cast<std::uint32_t>(grid.columns);
        }
    }
    HWY_INLINE void count(Record& record) {
        for (std::size_t g = 0;; ++g) {
            const LightGrid& grid = out_.grids[g];
            const Cells covered = cells(record, grid);
            if (covered.columns * covered.rows > kCoarser * kCoarser && g + 1 < out_.grids.size())
                continue;
            record.grid = static_cast<std::uint8_t>(g);
            for_each_cell(covered, grid, [&](std::uint32_t cell) { ++out_.starts[cell + 2]; });
            return;
        }
    }

    // Makes starts[c + 1] the start of cell c; false: its lists are too long.
    bool add_up() {
        double squares = 0;
        for (std::size_t cell = 0; cell < cells_; ++cell) {
            const double length = out_.starts[cell + 2];
            squares += length * length;
            out_.starts[cell + 2] += out_.starts[cell + 1];
        }
        if (squares <= kLongLists * out_.starts[cells_ + 1]) return true;
        out_.grids.clear();
        return false;
    }
    // starts[c + 1] is where the next entry of cell c goes, until it is where c + 1 starts.
    void fill() {
        constexpr std::size_t kReadAhead = 16;
        out_.entries.resize(out_.starts[cells_ + 1] + kReadAhead);
        for (std::size_t i = 0; i < used_; ++i) {
            const Record& record = records_[i];
            const LightGrid& grid = out_.grids[record.grid];
            for_each_cell(cells(record, grid), grid, [&](std::uint32_t cell) {
                out_.entries[out_.starts[cell + 1]++] = record.entry;
            });
        }
        std::erase_if(out_.grids, [&](const LightGrid& grid) {
            return out_.starts[grid.first_cell] == out_.starts[grid.first_cell + cells_of(grid)];
        });
    }

    LightBuffer& out_;
    const LightBuffer::Source& source_;
    Slot triangle_end_;
    Slot end_;
    PlaneRanges plane_;
    CubeRanges cube_;
    float extent_[2] = {};  // of u and v
    int faces_ = 0;
    std::uint32_t cells_ = 0;  // of all grids
    BigVector<Record> records_;
    std::size_t used_ = 0;
};

void make_light_buffer(LightBuffer& out, const LightPoint& light,
                       const LightBuffer::Source& source) {
    LightBufferMaker(out, light, source).run();
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/dispatch.h"

namespace nuvo {

LightBuffer::LightBuffer(const LightPoint& light, const Source& source, InstructionSet isa) {
    (NUVO_FOR_ISA(isa, make_light_buffer))(*this, light, source);
}

}  // namespace nuvo
#endif
