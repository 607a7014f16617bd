#include <algorithm>
#include <array>
#include <limits>

#include "methods.h"

// The surface area heuristic of all eight octants together: sum of area x items. One plane is moved
// at a time; the items of the four columns beside it change at edges only, so that one pass over
// the sorted edges finds the best place. [coordinate descent]

namespace nuvo::study {
namespace {

constexpr int kMostRounds = 4;

struct Edge {
    double at;
    unsigned columns;  // of the four columns, those that the box reaches
};

/// The best plane of one axis while the two others stay.
double best_plane(const SplitQuery& query, const Point3& planes, int axis) {
    const Bounds3& voxel = query.voxel.bounds;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const double clearance = query.margin > 0 ? 4 * query.margin : 0;
    std::vector<Edge> begins, ends;
    std::array<double, 4> lower{}, upper{};  // items of each column's two octants
    for (const Bounds3& box : query.boxes) {
        unsigned columns = 0;
        for (unsigned c = 0; c < 4; ++c) {
            const bool in_u = (c & 1) ? box.max[u] >= planes[u] : box.min[u] <= planes[u];
            const bool in_v = (c & 2) ? box.max[v] >= planes[v] : box.min[v] <= planes[v];
            if (in_u && in_v) columns |= 1U << c;
        }
        begins.push_back({box.min[axis] - clearance, columns});
        ends.push_back({box.max[axis] + clearance, columns});
        for (unsigned c = 0; c < 4; ++c) upper[c] += columns >> c & 1;
    }
    std::ranges::sort(begins, {}, &Edge::at);
    std::ranges::sort(ends, {}, &Edge::at);
    const auto cost = [&](double plane) {
        double sum = 0;
        for (unsigned c = 0; c < 4; ++c) {
            const double a = (c & 1) ? voxel.max[u] - planes[u] : planes[u] - voxel.min[u];
            const double b = (c & 2) ? voxel.max[v] - planes[v] : planes[v] - voxel.min[v];
            sum += (a * b + (plane - voxel.min[axis]) * (a + b)) * lower[c] +
                   (a * b + (voxel.max[axis] - plane) * (a + b)) * upper[c];
        }
        return sum;
    };
    double best = planes[axis], least = std::numeric_limits<double>::infinity();
    std::size_t end = 0;
    const auto visit = [&](double plane) {
        if (!(voxel.min[axis] < plane && plane < voxel.max[axis])) return;
        const double value = cost(plane);
        if (!(value < least)) return;
        least = value;
        best = plane;
    };
    // Counts as of a plane at each edge: boxes that begin below it are below, those that end above
    // it above; the box at the edge is on its own side only.
    const auto pass_ends = [&](double up_to) {
        for (; end < ends.size() && ends[end].at <= up_to; ++end) {
            for (unsigned c = 0; c < 4; ++c) upper[c] -= ends[end].columns >> c & 1;
            visit(ends[end].at);
        }
    };
    for (const Edge& begin : begins) {
        pass_ends(begin.at);
        visit(begin.at);
        for (unsigned c = 0; c < 4; ++c) lower[c] += begin.columns >> c & 1;
    }
    pass_ends(std::numeric_limits<double>::infinity());
    return best;
}

}  // namespace

MidpointStrategy eight_child(Evaluations*) {
    return [](const SplitQuery& query) -> std::optional<Point3> {
        std::optional<Point3> planes = sweep_midpoint(query);
        for (int round = 0; planes && round < kMostRounds; ++round) {
            const Point3 before = *planes;
            for (int axis = 0; axis < 3; ++axis) (*planes)[axis] = best_plane(query, *planes, axis);
            if (before == *planes) break;
        }
        return planes;
    };
}

}  // namespace nuvo::study
