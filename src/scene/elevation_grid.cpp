#include "mesh_source.h"

namespace nuvo::x3d {

namespace {

/// A number of rows or columns.
std::size_t read_dimension(const Fields& fields, std::string_view name) {
    const Integers values = fields.integers(name);
    if (values.size() > 1) fields.fail(name, "is more than one number");
    if (values.empty()) return 0;
    if (values[0] < 0) fields.fail(name, "is negative");
    return static_cast<std::size_t>(values[0]);
}

}  // namespace

void read_elevation_grid(MeshSource& source) {
    const Fields& fields = source.fields;
    const std::size_t columns = read_dimension(fields, "xDimension");
    const std::size_t rows = read_dimension(fields, "zDimension");
    const double x_spacing = fields.positive_number("xSpacing", 1);
    const double z_spacing = fields.positive_number("zSpacing", 1);
    const double crease_angle = fields.number("creaseAngle", 0);
    const Numbers heights = fields.numbers("height");
    const std::size_t count = columns * rows;  // each below 2^31
    if (heights.size() < count)
        fields.fail("height", std::to_string(heights.size()) + " numbers where " +
                                  std::to_string(count) + " belong");
    if (heights.size() > count) fields.warn("height", "with more numbers than the grid has points");
    source.budget.take(5 * count, fields);

    Polygons& polygons = source.polygons;
    polygons.points.reserve(count);
    for (std::size_t z = 0; z < rows; ++z)
        for (std::size_t x = 0; x < columns; ++x)
            polygons.points.push_back({x_spacing * static_cast<double>(x), heights[x + z * columns],
                                       z_spacing * static_cast<double>(z)});
    for (std::size_t z = 0; z + 1 < rows; ++z)
        for (std::size_t x = 0; x + 1 < columns; ++x) {
            const auto corner = static_cast<std::uint32_t>(x + z * columns);
            const auto below = static_cast<std::uint32_t>(corner + columns);
            for (const std::uint32_t c : {corner, below, below + 1, corner + 1})
                polygons.corners.push_back(c);
            polygons.end_polygon();
        }

    const bool normal_per_vertex = fields.boolean("normalPerVertex", true);
    read_normals(source, {normal_per_vertex, {}});
    if (polygons.normals.values.empty() && normal_per_vertex) smooth(source, crease_angle);
    read_colors(source, {fields.boolean("colorPerVertex", true), {}});
}

}  // namespace nuvo::x3d
