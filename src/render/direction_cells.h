#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "nuvo/geometry/predicates.h"
#include "nuvo/math/bounds.h"
#include "nuvo/octree/octree.h"

namespace nuvo {

/// What may be met by rays from one point, an eye or a light, by their direction: a cube of cells
/// around the point, whose lists hold at any scale. [Haines and Greenberg 1986; numerics: direction
/// cells]
class DirectionCells {
  public:
    /// `point`: where all rays pass.
    explicit DirectionCells(const Point3& point) : point_(point) {}

    /// Lists an item in all cells in which a ray may meet it.
    void add(ItemId item, const Triangle& triangle);
    void add(ItemId item, const Bounds3& box);
    /// Entries of all lists.
    std::size_t size() const { return size_; }

    /// What a ray from the point in direction d, known within a roundoff, may meet.
    std::span<const ItemId> towards(const Vector3& d) const;

  private:
    static constexpr int kSide = 8;  // cells along an edge of the cube
    struct Face {
        int axis;    // across the face
        double way;  // -1, 1: which of the two
    };
    using Marks = std::array<bool, kSide>;

    static constexpr std::size_t cell(std::size_t face, int column, int row) {
        return (face * kSide + static_cast<std::size_t>(column)) * kSide +
               static_cast<std::size_t>(row);
    }
    static Face face(std::size_t index) {
        return {static_cast<int>(index / 2), index % 2 == 0 ? 1.0 : -1.0};
    }
    bool reaches(const Face& face, std::span<const Point3> corners) const;
    Marks columns(const Face& face, int axis, std::span<const Point3> corners) const;
    void list(ItemId item, std::span<const Point3> corners, const EdgePlanes* planes);

    Point3 point_;
    std::array<std::vector<ItemId>, 6 * kSide * kSide> cells_;
    std::size_t size_ = 0;
};

}  // namespace nuvo
