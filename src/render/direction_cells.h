#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "nuvo/geometry/predicates.h"
#include "nuvo/math/bounds.h"
#include "nuvo/octree/octree.h"

namespace nuvo {

/// What may be met by rays from one point, an eye or a light, by their direction: a cube of cells
/// around the point, whose lists hold at any scale. Where many rays look and find much, a cell is
/// divided into cells. [Haines and Greenberg 1986; numerics: direction cells]
class DirectionCells {
  public:
    /// Entries of all lists; cells are not divided beyond.
    static constexpr std::size_t kRoom = std::size_t{1} << 20;

    /// `point`: where all rays pass.
    explicit DirectionCells(const Point3& point);

    /// Lists an item in all cells in which a ray may meet it: to be called for all items before
    /// the first towards().
    void add(ItemId item, const Triangle& triangle);
    void add(ItemId item, const Bounds3& box);
    /// Entries of all lists.
    std::size_t size() const { return size_; }

    /// What a ray from the point in direction d, known within a roundoff, may meet; good until the
    /// next call. `add_again(item)` has to add an item as before, for cells that are divided.
    template <typename AddAgain>
    std::span<const ItemId> towards(const Vector3& d, AddAgain&& add_again) {
        Search search = start(d);
        while (true) {
            Cell& cell = step(search);
            if (!cell.finer && is_due(cell, search)) {
                // A sample tells whether it helps.
                const std::size_t stride = std::max<std::size_t>(1, cell.items.size() / kSample);
                for (const std::size_t step : {stride, std::size_t{1}}) {
                    divide(cell, search);
                    for (std::size_t i = 0; i < cell.items.size(); i += step)
                        add_again(cell.items[i]);
                    if (!keep_if_shorter(cell, (cell.items.size() + step - 1) / step)) break;
                }
            }
            if (!cell.finer) return cell.items;
            search.grid = cell.finer.get();
        }
    }

  private:
    static constexpr std::size_t kSample = 16;
    static constexpr int kSide = 8;  // cells along an edge of the cube, or of a divided cell
    struct Grid;
    struct Cell {
        std::vector<ItemId> items;
        std::unique_ptr<Grid> finer;
        int asked = 0;  // negative: dividing it would not help
    };
    struct Grid {
        std::array<Cell, kSide * kSide> cells;
        Cell& at(int column, int row) {
            return cells[static_cast<std::size_t>(column * kSide + row)];
        }
    };
    // A square on a face of the cube [-1, 1]^3.
    struct Window {
        int axis;    // across the face
        double way;  // -1, 1: which of the two
        double low[2];
        double width;
    };
    struct Search {
        Grid* grid;
        Window window;
        double place[2];  // in the window, 0 to 1
    };
    // Where items are listed.
    struct Target {
        Grid* grid;
        Window window;
    };
    using Marks = std::array<bool, kSide>;

    Search start(const Vector3& d);
    static Cell& step(Search& search);
    bool is_due(Cell& cell, const Search& search) const;
    void divide(Cell& cell, const Search& search);
    void forget_parts(Cell& cell);
    bool keep_if_shorter(Cell& cell, std::size_t added);

    bool reaches(const Window& window, std::span<const Point3> corners) const;
    Marks columns(const Window& window, int i, std::span<const Point3> corners) const;
    void list(ItemId item, std::span<const Point3> corners, const EdgePlanes* planes);
    void list(ItemId item, std::span<const Point3> corners, const EdgePlanes* planes,
              const Target& target);

    Point3 point_;
    std::array<Grid, 6> faces_;
    std::vector<Target> targets_;
    std::unordered_map<ItemId, EdgePlanes> planes_;  // of triangles, found once for all divisions
    std::size_t size_ = 0;
};

}  // namespace nuvo
