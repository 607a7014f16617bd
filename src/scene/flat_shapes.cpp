#include <cmath>
#include <numbers>

#include "mesh_source.h"

namespace nuvo::x3d {

namespace {

/// Appends a circle in the plane z = 0, counterclockwise seen from +z, and returns its first point.
std::uint32_t append_circle(Polygons& polygons, double radius) {
    const auto first = static_cast<std::uint32_t>(polygons.points.size());
    for (std::uint32_t i = 0; i < kRoundSides; ++i) {
        const double angle = 2 * std::numbers::pi * i / kRoundSides;
        polygons.points.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
    return first;
}

void take_all(MeshSource& source) {
    source.budget.take(source.polygons.points.size() + source.polygons.corners.size(),
                       source.fields);
}

}  // namespace

void read_rectangle(MeshSource& source) {
    const std::array<double, 2> size = source.fields.pair("size", 2, 2);
    if (size[0] < 0 || size[1] < 0) source.fields.fail("size", "is negative");
    if (size[0] == 0 || size[1] == 0) source.fields.warn("size", "of zero");
    const double x = size[0] / 2, y = size[1] / 2;
    Polygons& polygons = source.polygons;
    polygons.points = {{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}};
    polygons.corners = {0, 1, 2, 3};
    polygons.end_polygon();
    take_all(source);
}

void read_disk(MeshSource& source) {
    const Fields& fields = source.fields;
    const double outer = fields.positive_number("outerRadius", 1);
    const double inner = fields.number("innerRadius", 0);
    if (inner < 0) fields.fail("innerRadius", "is negative");
    if (inner > outer) fields.fail("innerRadius", "is greater than the outerRadius");
    if (inner == outer)
        fields.fail("innerRadius", "is the outerRadius: a line, which is not drawn");
    Polygons& polygons = source.polygons;
    const std::uint32_t rim = append_circle(polygons, outer);
    if (inner == 0) {
        for (std::uint32_t i = 0; i < kRoundSides; ++i) polygons.corners.push_back(rim + i);
        polygons.end_polygon();
        cut_round_polygons(polygons);
    } else {
        const std::uint32_t hole = append_circle(polygons, inner);
        for (std::uint32_t i = 0; i < kRoundSides; ++i) {
            const std::uint32_t next = (i + 1) % kRoundSides;
            for (const std::uint32_t corner : {hole + i, rim + i, rim + next, hole + next})
                polygons.corners.push_back(corner);
            polygons.end_polygon();
        }
    }
    take_all(source);
}

void read_triangles_2d(MeshSource& source) {
    Polygons& polygons = source.polygons;
    for (const Vector3& p : source.fields.pairs("vertices"))
        polygons.points.push_back({p.x, p.z, 0});
    const std::size_t count = polygons.points.size();
    if (count % 3 != 0) source.fields.warn("vertices", "with an incomplete last triangle");
    for (std::uint32_t i = 0; i < count - count % 3; ++i) {
        polygons.corners.push_back(i);
        if (i % 3 == 2) polygons.end_polygon();
    }
    take_all(source);
}

}  // namespace nuvo::x3d
