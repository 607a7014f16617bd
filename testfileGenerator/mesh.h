#pragma once

#include <array>
#include <vector>

namespace nuvo::generator {

struct Point {
    double x = 0;
    double y = 0;
    double z = 0;
};

/// A triangle mesh; triangles name their corners counter-clockwise as seen from outside.
struct Mesh {
    std::vector<Point> points;
    std::vector<std::array<int, 3>> triangles;
};

/// The eight triangles over the points at `radius` on the six half axes.
Mesh octahedron(double radius);

/// A regular icosahedron of circumradius `radius` after `subdivisions` >= 0 rounds that cut each
/// triangle into four and push the new corners out to the sphere: 20 * 4^subdivisions triangles.
/// Its mirror planes are x = 0, y = 0 and z = 0. Coordinates are rounded to six decimals.
Mesh icosphere(double radius, int subdivisions);

/// `value` rounded to the nearest multiple of 10^-6: short to write, and blind to the last bit.
double six_decimals(double value);

}  // namespace nuvo::generator
