#include <cmath>
#include <numbers>

#include "mesh_source.h"

namespace nuvo::x3d {

namespace {

constexpr std::uint32_t kSides = kRoundSides;

/// The unit circle from -z on, counterclockwise seen from +y.
Vector3 on_circle(double side) {
    const double angle = 2 * std::numbers::pi * side / kSides;
    return {-std::sin(angle), 0, -std::cos(angle)};
}

/// Appends a ring of points at height y and returns the place of its first.
std::uint32_t append_ring(Polygons& polygons, double radius, double y) {
    const auto first = static_cast<std::uint32_t>(polygons.points.size());
    for (std::uint32_t i = 0; i < kSides; ++i)
        polygons.points.push_back(on_circle(i) * radius + Vector3{0, y, 0});
    return first;
}

void append_corner(Polygons& polygons, std::uint32_t point, std::uint32_t normal) {
    polygons.corners.push_back(point);
    polygons.normals.corners.push_back(normal);
}

/// A ring as a polygon that is seen from above, or from below.
void append_cap(Polygons& polygons, std::uint32_t ring, bool above) {
    const auto normal = static_cast<std::uint32_t>(polygons.normals.values.size());
    polygons.normals.values.push_back({0, above ? 1.0 : -1.0, 0});
    for (std::uint32_t i = 0; i < kSides; ++i)
        append_corner(polygons, ring + (above ? i : kSides - 1 - i), normal);
    polygons.end_polygon();
}

void take_all(MeshSource& source) {
    const Polygons& polygons = source.polygons;
    source.budget.take(polygons.points.size() + polygons.corners.size() +
                           polygons.normals.values.size() + polygons.normals.corners.size(),
                       source.fields);
}

}  // namespace

void cut_round_polygons(Polygons& polygons) {
    for (std::size_t i = 0; i < polygons.count(); ++i) {
        const std::uint32_t begin = polygons.ends[i];
        const std::uint32_t count = polygons.ends[i + 1] - begin;
        std::uint32_t step = 1;
        if (count == kSides)
            for (; 2 * step < kSides / 2; step *= 2)
                for (std::uint32_t c = 0; c < kSides; c += 2 * step)
                    polygons.cuts.push_back(
                        {begin + c, begin + c + step, begin + (c + 2 * step) % kSides});
        for (std::uint32_t c = step; c + step < count; c += step)
            polygons.cuts.push_back({begin, begin + c, begin + c + step});
    }
}

void read_box(MeshSource& source) {
    const Vector3 size = source.fields.vector("size", {2, 2, 2});
    if (size.x < 0 || size.y < 0 || size.z < 0) source.fields.fail("size", "is negative");
    if (size.x == 0 || size.y == 0 || size.z == 0) source.fields.warn("size", "of zero");
    Polygons& polygons = source.polygons;
    for (std::uint32_t i = 0; i < 8; ++i)  // bit by bit: right, top, front
        polygons.points.push_back({(i & 1 ? size.x : -size.x) / 2, (i & 2 ? size.y : -size.y) / 2,
                                   (i & 4 ? size.z : -size.z) / 2});
    constexpr std::uint32_t kFaces[6][4] = {{4, 5, 7, 6}, {1, 0, 2, 3}, {0, 4, 6, 2},
                                            {5, 1, 3, 7}, {6, 7, 3, 2}, {0, 1, 5, 4}};
    for (const auto& face : kFaces) {
        polygons.corners.insert(polygons.corners.end(), face, face + 4);
        polygons.end_polygon();
    }
    take_all(source);
}

void read_cylinder(MeshSource& source) {
    const double radius = source.fields.positive_number("radius", 1);
    const double height = source.fields.positive_number("height", 2);
    Polygons& polygons = source.polygons;
    const std::uint32_t low = append_ring(polygons, radius, -height / 2);
    const std::uint32_t high = append_ring(polygons, radius, height / 2);
    if (source.fields.boolean("side", true)) {
        for (std::uint32_t i = 0; i < kSides; ++i) polygons.normals.values.push_back(on_circle(i));
        for (std::uint32_t i = 0; i < kSides; ++i) {
            const std::uint32_t next = (i + 1) % kSides;
            append_corner(polygons, low + i, i);
            append_corner(polygons, low + next, next);
            append_corner(polygons, high + next, next);
            append_corner(polygons, high + i, i);
            polygons.end_polygon();
        }
    }
    if (source.fields.boolean("top", true)) append_cap(polygons, high, true);
    if (source.fields.boolean("bottom", true)) append_cap(polygons, low, false);
    cut_round_polygons(polygons);
    take_all(source);
}

void read_cone(MeshSource& source) {
    const double radius = source.fields.positive_number("bottomRadius", 1);
    const double height = source.fields.positive_number("height", 2);
    Polygons& polygons = source.polygons;
    const std::uint32_t low = append_ring(polygons, radius, -height / 2);
    if (source.fields.boolean("side", true)) {
        // A circle at the rim's corners, then one between them for the apex, which every side has
        // for itself.
        const auto normal_at = [&](double side) {
            return normalized(on_circle(side) * height + Vector3{0, radius, 0});
        };
        for (std::uint32_t i = 0; i < kSides; ++i) polygons.normals.values.push_back(normal_at(i));
        for (std::uint32_t i = 0; i < kSides; ++i)
            polygons.normals.values.push_back(normal_at(i + 0.5));
        const auto apex = static_cast<std::uint32_t>(polygons.points.size());
        polygons.points.push_back({0, height / 2, 0});
        for (std::uint32_t i = 0; i < kSides; ++i) {
            const std::uint32_t next = (i + 1) % kSides;
            append_corner(polygons, low + i, i);
            append_corner(polygons, low + next, next);
            append_corner(polygons, apex, kSides + i);
            polygons.end_polygon();
        }
    }
    if (source.fields.boolean("bottom", true)) append_cap(polygons, low, false);
    cut_round_polygons(polygons);
    take_all(source);
}

}  // namespace nuvo::x3d
