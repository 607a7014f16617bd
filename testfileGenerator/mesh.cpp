#include "mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace nuvo::generator {

namespace {

/// The point of the unit sphere in the direction of `p`, by operations that IEEE 754 rounds
/// correctly, so that every platform gets the same one.
Point normalized(Point p) {
    const double length = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    return {p.x / length, p.y / length, p.z / length};
}

Mesh unit_icosahedron() {
    const double golden = (1 + std::sqrt(5.0)) / 2;
    Mesh mesh;
    mesh.points = {{-1, golden, 0}, {1, golden, 0}, {-1, -golden, 0}, {1, -golden, 0},
                   {0, -1, golden}, {0, 1, golden}, {0, -1, -golden}, {0, 1, -golden},
                   {golden, 0, -1}, {golden, 0, 1}, {-golden, 0, -1}, {-golden, 0, 1}};
    mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                      {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                      {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                      {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (Point& p : mesh.points) p = normalized(p);
    return mesh;
}

/// Cuts every triangle at the middles of its edges; triangles that share an edge share its middle.
Mesh subdivided(const Mesh& coarse) {
    Mesh fine{coarse.points, {}};
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
        const auto [found, is_new] =
            middles.try_emplace(std::minmax(a, b), static_cast<int>(fine.points.size()));
        if (is_new) {
            const Point p = fine.points[static_cast<std::size_t>(a)];
            const Point q = fine.points[static_cast<std::size_t>(b)];
            fine.points.push_back(normalized({p.x + q.x, p.y + q.y, p.z + q.z}));
        }
        return found->second;
    };
    for (const auto& [a, b, c] : coarse.triangles) {
        const int ab = middle(a, b);
        const int bc = middle(b, c);
        const int ca = middle(c, a);
        fine.triangles.push_back({a, ab, ca});
        fine.triangles.push_back({ab, b, bc});
        fine.triangles.push_back({ca, bc, c});
        fine.triangles.push_back({ab, bc, ca});
    }
    return fine;
}

}  // namespace

Mesh octahedron(double radius) {
    return {
        {{radius, 0, 0},
         {-radius, 0, 0},
         {0, radius, 0},
         {0, -radius, 0},
         {0, 0, radius},
         {0, 0, -radius}},
        {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

Mesh icosphere(double radius, int subdivisions) {
    Mesh mesh = unit_icosahedron();
    for (int i = 0; i < subdivisions; ++i) mesh = subdivided(mesh);
    for (Point& p : mesh.points) {
        p = {six_decimals(radius * p.x), six_decimals(radius * p.y), six_decimals(radius * p.z)};
    }
    return mesh;
}

double six_decimals(double value) { return std::round(value * 1e6) / 1e6; }

}  // namespace nuvo::generator
