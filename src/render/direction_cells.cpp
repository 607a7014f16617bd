#include "direction_cells.h"

#include <algorithm>
#include <cmath>

namespace nuvo {
namespace {

// Cells overlap by that much on each side, where their cube's faces are at distance 1: far more
// than the rounding of a direction's cell.
constexpr double kOverlap = 0x1p-20;

// The edge function of normal n over a cell, given by the ranges of its two free coordinates: its
// sign where it has one everywhere, else 0.
int sign_over(const Vector3& n, const Vector3& low, const Vector3& high) {
    const double slack =
        4 * kOverlap * (std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z)) + kUnderflow;
    double least = 0;
    double most = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = n[axis] * low[axis];
        const double b = n[axis] * high[axis];
        least += std::fmin(a, b);
        most += std::fmax(a, b);
    }
    return least > slack ? 1 : most < -slack ? -1 : 0;
}

// No line through the cell crosses inside the triangle: two edge functions have opposite signs all
// over it.
bool outside(const EdgePlanes& planes, const Vector3& low, const Vector3& high) {
    bool positive = false;
    bool negative = false;
    for (const Vector3& n : planes.normal) {
        const int sign = sign_over(n, low, high);
        positive = positive || sign > 0;
        negative = negative || sign < 0;
    }
    return positive && negative;
}

}  // namespace

// Whether any corner lies on the face's side of the point: differences have their true sign.
bool DirectionCells::reaches(const Face& face, std::span<const Point3> corners) const {
    return std::any_of(corners.begin(), corners.end(), [&](const Point3& p) {
        return face.way * (p[face.axis] - point_[face.axis]) > 0;
    });
}

// Which columns of cells along `axis` the corners' hull may meet: not those to whose one side all
// corners lie. With u along `axis` and w across the face a column's sides are u = s w.
DirectionCells::Marks DirectionCells::columns(const Face& face, int axis,
                                              std::span<const Point3> corners) const {
    const auto all_beyond = [&](double s, double side) {
        return std::all_of(corners.begin(), corners.end(), [&](const Point3& p) {
            const double u = p[axis] - point_[axis];
            const double sw = s * face.way * (p[face.axis] - point_[face.axis]);
            return side * (u - sw) > gamma(4) * (std::fabs(u) + std::fabs(sw)) + 2 * kUnderflow;
        });
    };
    Marks marks;
    for (int i = 0; i < kSide; ++i) {
        const double low = -1 + 2.0 * i / kSide - kOverlap;
        const double high = -1 + 2.0 * (i + 1) / kSide + kOverlap;
        marks[static_cast<std::size_t>(i)] = !all_beyond(low, -1) && !all_beyond(high, 1);
    }
    return marks;
}

void DirectionCells::list(ItemId item, std::span<const Point3> corners, const EdgePlanes* planes) {
    for (std::size_t f = 0; f < 6; ++f) {
        const Face side = face(f);
        if (!reaches(side, corners)) continue;
        const int u = (side.axis + 1) % 3;
        const int v = (side.axis + 2) % 3;
        const Marks across = columns(side, u, corners);
        const Marks along = columns(side, v, corners);
        for (int i = 0; i < kSide; ++i) {
            for (int j = 0; j < kSide; ++j) {
                if (!across[static_cast<std::size_t>(i)] || !along[static_cast<std::size_t>(j)])
                    continue;
                Vector3 low;
                low[side.axis] = side.way;
                low[u] = -1 + 2.0 * i / kSide;
                low[v] = -1 + 2.0 * j / kSide;
                Vector3 high = low;
                high[u] += 2.0 / kSide;
                high[v] += 2.0 / kSide;
                if (planes && outside(*planes, low, high)) continue;
                cells_[cell(f, i, j)].push_back(item);
                ++size_;
            }
        }
    }
}

void DirectionCells::add(ItemId item, const Triangle& triangle) {
    const Point3 corners[3] = {triangle.a, triangle.b, triangle.c};
    const EdgePlanes planes = edge_planes_through(triangle, point_);
    list(item, corners, &planes);
}

void DirectionCells::add(ItemId item, const Bounds3& box) {
    Point3 corners[8];
    for (std::size_t i = 0; i < 8; ++i)
        corners[i] = {(i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                      (i & 4) != 0 ? box.max.z : box.min.z};
    list(item, corners, nullptr);
}

std::span<const ItemId> DirectionCells::towards(const Vector3& d) const {
    int axis = std::fabs(d.y) > std::fabs(d.x) ? 1 : 0;
    if (std::fabs(d.z) > std::fabs(d[axis])) axis = 2;
    const double w = std::fabs(d[axis]);
    const auto index = [&](double u) {
        return std::clamp(static_cast<int>((u / w + 1) * (kSide / 2)), 0, kSide - 1);
    };
    const std::size_t f = 2 * static_cast<std::size_t>(axis) + (d[axis] < 0 ? 1 : 0);
    return cells_[cell(f, index(d[(axis + 1) % 3]), index(d[(axis + 2) % 3]))];
}

}  // namespace nuvo
