#include "direction_cells.h"

#include <algorithm>
#include <cmath>

namespace nuvo {
namespace {

// Cells overlap by that much on each side, where their cube's faces are at distance 1: far more
// than the rounding of a direction's cell.
constexpr double kOverlap = 0x1p-20;

// A cell is divided for the rays to come where it lists more than kFew items and has been asked for
// so often that testing them has cost as much; 8^4 cells along the cube's edge are as fine as
// pixels.
constexpr std::size_t kFew = 16;
constexpr int kPatience = 16;
constexpr double kFinest = 0x1p-11;

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
        least += std::min(a, b);
        most += std::max(a, b);
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

DirectionCells::DirectionCells(const Point3& point) : point_(point) {
    for (std::size_t i = 0; i < faces_.size(); ++i)
        targets_.push_back(
            {&faces_[i], {static_cast<int>(i / 2), i % 2 == 0 ? 1.0 : -1.0, {-1, -1}, 2}});
}

DirectionCells::Search DirectionCells::start(const Vector3& d) {
    int axis = std::fabs(d.y) > std::fabs(d.x) ? 1 : 0;
    if (std::fabs(d.z) > std::fabs(d[axis])) axis = 2;
    const double w = std::fabs(d[axis]);
    const bool lower = d[axis] < 0;
    return {&faces_[2 * static_cast<std::size_t>(axis) + (lower ? 1 : 0)],
            {axis, lower ? -1.0 : 1.0, {-1, -1}, 2},
            {(d[(axis + 1) % 3] / w + 1) / 2, (d[(axis + 2) % 3] / w + 1) / 2}};
}

// All but the first quotients is exact.
DirectionCells::Cell& DirectionCells::step(Search& search) {
    int index[2];
    search.window.width /= kSide;
    for (int k = 0; k < 2; ++k) {
        search.place[k] *= kSide;
        index[k] = std::clamp(static_cast<int>(search.place[k]), 0, kSide - 1);
        search.place[k] -= index[k];
        search.window.low[k] += index[k] * search.window.width;
    }
    return search.grid->at(index[0], index[1]);
}

bool DirectionCells::is_due(Cell& cell, const Search& search) const {
    return cell.items.size() > kFew && search.window.width > kFinest && size_ < kRoom &&
           cell.asked >= 0 && ++cell.asked >= kPatience;
}

// Into empty parts.
void DirectionCells::divide(Cell& cell, const Search& search) {
    if (cell.finer) forget_parts(cell);
    cell.finer = std::make_unique<Grid>();
    targets_.assign(1, {cell.finer.get(), search.window});
}

void DirectionCells::forget_parts(Cell& cell) {
    for (const Cell& part : cell.finer->cells) size_ -= part.items.size();
    cell.finer.reset();
}

// Whether parts list less than half of the items that were added, on average.
bool DirectionCells::keep_if_shorter(Cell& cell, std::size_t added) {
    std::size_t entries = 0;
    for (const Cell& part : cell.finer->cells) entries += part.items.size();
    if (2 * entries <= cell.finer->cells.size() * added) return true;
    forget_parts(cell);
    cell.asked = -1;
    return false;
}

// Whether any corner lies on the face's side of the point: differences have their true sign.
bool DirectionCells::reaches(const Window& window, std::span<const Point3> corners) const {
    return std::any_of(corners.begin(), corners.end(), [&](const Point3& p) {
        return window.way * (p[window.axis] - point_[window.axis]) > 0;
    });
}

// Which columns of cells along the window's axis i the corners' hull may meet: not those to whose
// one side all corners lie. With u along that axis and w across the face a column's sides are
// u = s w.
DirectionCells::Marks DirectionCells::columns(const Window& window, int i,
                                              std::span<const Point3> corners) const {
    const int axis = (window.axis + 1 + i) % 3;
    const auto all_beyond = [&](double s, double side) {
        return std::all_of(corners.begin(), corners.end(), [&](const Point3& p) {
            const double u = p[axis] - point_[axis];
            const double sw = s * window.way * (p[window.axis] - point_[window.axis]);
            return side * (u - sw) > gamma(4) * (std::fabs(u) + std::fabs(sw)) + 2 * kUnderflow;
        });
    };
    Marks marks;
    for (int k = 0; k < kSide; ++k) {
        const double low = window.low[i] + k * window.width / kSide - kOverlap;
        const double high = window.low[i] + (k + 1) * window.width / kSide + kOverlap;
        marks[static_cast<std::size_t>(k)] = !all_beyond(low, -1) && !all_beyond(high, 1);
    }
    return marks;
}

void DirectionCells::list(ItemId item, std::span<const Point3> corners, const EdgePlanes* planes) {
    for (const Target& target : targets_)
        if (reaches(target.window, corners)) list(item, corners, planes, target);
}

void DirectionCells::list(ItemId item, std::span<const Point3> corners, const EdgePlanes* planes,
                          const Target& target) {
    const Window& window = target.window;
    const Marks across = columns(window, 0, corners);
    const Marks along = columns(window, 1, corners);
    const int u = (window.axis + 1) % 3;
    const int v = (window.axis + 2) % 3;
    const double width = window.width / kSide;
    for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
            if (!across[static_cast<std::size_t>(i)] || !along[static_cast<std::size_t>(j)])
                continue;
            Vector3 low;
            low[window.axis] = window.way;
            low[u] = window.low[0] + i * width;
            low[v] = window.low[1] + j * width;
            Vector3 high = low;
            high[u] += width;
            high[v] += width;
            if (planes && outside(*planes, low, high)) continue;
            target.grid->at(i, j).items.push_back(item);
            ++size_;
        }
    }
}

void DirectionCells::add(ItemId item, const Triangle& triangle) {
    const Point3 corners[3] = {triangle.a, triangle.b, triangle.c};
    const auto [planes, is_new] = planes_.try_emplace(item);
    if (is_new) planes->second = edge_planes_through(triangle, point_);
    list(item, corners, &planes->second);
}

void DirectionCells::add(ItemId item, const Bounds3& box) {
    Point3 corners[8];
    for (std::size_t i = 0; i < 8; ++i)
        corners[i] = {(i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                      (i & 4) != 0 ? box.max.z : box.min.z};
    list(item, corners, nullptr);
}

}  // namespace nuvo
