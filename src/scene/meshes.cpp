#include "meshes.h"

#include <numbers>

#include "node_names.h"
#include "polygons.h"

namespace nuvo::x3d {

namespace {

/// The property nodes of a geometry; null where there is none.
struct Properties {
    const Element* coordinate = nullptr;
    const Element* normal = nullptr;
};

Properties find_properties(const Element& geometry, Messages& messages) {
    Properties found;
    for (const Element& child : geometry.children) {
        const bool coordinate = child.name == "Coordinate" || child.name == "CoordinateDouble";
        if (coordinate && found.coordinate == nullptr)
            found.coordinate = &child.node();
        else if (child.name == "Normal" && found.normal == nullptr)
            found.normal = &child.node();
        else if (!is_silent(child.name))
            warn_not_drawn(child, messages);
    }
    return found;
}

/// `index` as a place in a list of `count` `what`s; throws Error at entry `entry` of `field`.
std::uint32_t checked(std::int32_t index, std::size_t count, const Fields& fields,
                      std::string_view field, std::size_t entry, const char* what) {
    if (index < 0 || static_cast<std::size_t>(index) >= count)
        fields.fail(field, "entry " + std::to_string(entry) + ": index " + std::to_string(index) +
                               " of " + std::to_string(count) + " " + what);
    return static_cast<std::uint32_t>(index);
}

/// Where the polygons of an IndexedFaceSet stand in the file.
struct FaceNumbers {
    std::vector<std::uint32_t> face;  // per polygon: its number among all faces, short ones counted
    std::vector<std::uint32_t> entry;  // per corner: its place in coordIndex
};

/// Reads coordIndex, where -1 ends each face. Faces of fewer than three corners are left out.
FaceNumbers read_faces(const Fields& fields, Polygons& polygons, VertexBudget& budget) {
    const std::vector<std::int32_t> indices = fields.integers("coordIndex");
    budget.take(indices.size(), fields);
    FaceNumbers numbers;
    std::uint32_t face = 0;
    std::size_t begin = 0;
    for (std::size_t i = 0; i <= indices.size(); ++i) {
        if (i < indices.size() && indices[i] != -1) continue;
        if (i - begin >= 3) {
            for (std::size_t c = begin; c < i; ++c) {
                polygons.corners.push_back(
                    checked(indices[c], polygons.points.size(), fields, "coordIndex", c, "points"));
                numbers.entry.push_back(static_cast<std::uint32_t>(c));
            }
            polygons.end_polygon();
            numbers.face.push_back(face);
        } else if (i > begin) {
            fields.warn("coordIndex", "with a face of fewer than three corners left out");
        }
        if (i > begin) ++face;
        begin = i + 1;
    }
    return numbers;
}

/// Triangles over consecutive entries of `corner(i)`, i < count; an incomplete last one is left
/// out.
template <typename Corner>
void read_triangles(std::size_t count, Polygons& polygons, Corner corner) {
    polygons.corners.reserve(count);
    polygons.ends.reserve(count / 3 + 1);
    for (std::size_t i = 0; i < count - count % 3; ++i) {
        polygons.corners.push_back(corner(i));
        if (i % 3 == 2) polygons.end_polygon();
    }
}

void read_normals(const Element& normal, Messages& messages, Polygons& polygons,
                  VertexBudget& budget) {
    const Fields fields(normal, messages);
    polygons.normals = fields.vectors("vector");
    budget.take(polygons.normals.size(), fields);
}

/// Gives polygon i's corners the normal `normal_of(i)`.
template <typename NormalOf>
void assign_per_polygon(Polygons& polygons, NormalOf normal_of) {
    polygons.corner_normals.reserve(polygons.corners.size());
    for (std::size_t i = 0; i < polygons.count(); ++i) {
        const std::uint32_t normal = normal_of(i);
        polygons.corner_normals.insert(polygons.corner_normals.end(),
                                       polygons.ends[i + 1] - polygons.ends[i], normal);
    }
}

/// Normals that the points' own indices choose.
void assign_by_point(Polygons& polygons, const Fields& fields) {
    for (std::size_t c = 0; c < polygons.corners.size(); ++c)
        checked(static_cast<std::int32_t>(polygons.corners[c]), polygons.normals.size(), fields,
                "normal", c, "normals");
    // to_mesh keeps them beside the points.
    polygons.normals.resize(polygons.points.size());
}

/// The normals given for an IndexedFaceSet (ISO/IEC 19775-1 clause 13, normalPerVertex).
void assign_face_set_normals(const Fields& fields, const FaceNumbers& numbers, bool per_vertex,
                             Polygons& polygons, VertexBudget& budget) {
    const std::vector<std::int32_t> index = fields.integers("normalIndex");
    budget.take(index.size(), fields);
    const auto entry = [&](std::size_t i) {
        if (i >= index.size())
            fields.fail("normalIndex", std::to_string(index.size()) + " entries, but entry " +
                                           std::to_string(i) + " is needed");
        return checked(index[i], polygons.normals.size(), fields, "normalIndex", i, "normals");
    };
    if (!per_vertex) {
        assign_per_polygon(polygons, [&](std::size_t i) {
            const std::uint32_t face = numbers.face[i];
            return index.empty() ? checked(static_cast<std::int32_t>(face), polygons.normals.size(),
                                           fields, "normal", face, "normals")
                                 : entry(face);
        });
    } else if (index.empty()) {
        assign_by_point(polygons, fields);
    } else {
        for (const std::uint32_t place : numbers.entry)
            polygons.corner_normals.push_back(entry(place));
    }
}

/// The normals given for sets of triangles.
void assign_triangle_normals(const Fields& fields, bool per_vertex, Polygons& polygons) {
    if (per_vertex) {
        assign_by_point(polygons, fields);
    } else {
        assign_per_polygon(polygons, [&](std::size_t i) {
            return checked(static_cast<std::int32_t>(i), polygons.normals.size(), fields, "normal",
                           i, "normals");
        });
    }
}

void warn_concave(const Fields& fields, const Polygons& polygons) {
    if (fields.boolean("convex", true)) return;
    for (std::size_t i = 0; i < polygons.count(); ++i) {
        if (polygons.ends[i + 1] - polygons.ends[i] == 3) continue;
        fields.warn("convex", "of false: its polygons are drawn as if they were convex");
        return;
    }
}

void read_face_set(const Fields& fields, bool ccw, const Element* normal, Messages& messages,
                   Polygons& polygons, VertexBudget& budget) {
    const bool per_vertex = fields.boolean("normalPerVertex", true);
    const double crease_angle = fields.number("creaseAngle", 0);
    const FaceNumbers numbers = read_faces(fields, polygons, budget);
    warn_concave(fields, polygons);
    if (normal != nullptr) read_normals(*normal, messages, polygons, budget);
    if (!polygons.normals.empty())
        assign_face_set_normals(fields, numbers, per_vertex, polygons, budget);
    else if (per_vertex)
        generate_normals(polygons, crease_angle, ccw);
}

void read_triangle_set(const Fields& fields, bool indexed, bool ccw, const Element* normal,
                       Messages& messages, Polygons& polygons, VertexBudget& budget) {
    const bool per_vertex = fields.boolean("normalPerVertex", true);
    const std::size_t points = polygons.points.size();
    if (indexed) {
        const std::vector<std::int32_t> index = fields.integers("index");
        budget.take(index.size(), fields);
        read_triangles(index.size(), polygons, [&](std::size_t i) {
            return checked(index[i], points, fields, "index", i, "points");
        });
        if (index.size() % 3 != 0) fields.warn("index", "with an incomplete last triangle");
    } else {
        read_triangles(points, polygons,
                       [](std::size_t i) { return static_cast<std::uint32_t>(i); });
        if (points % 3 != 0) fields.warn("coord", "with an incomplete last triangle");
    }
    if (normal != nullptr) read_normals(*normal, messages, polygons, budget);
    if (!polygons.normals.empty())
        assign_triangle_normals(fields, per_vertex, polygons);
    else if (indexed && per_vertex)
        generate_normals(polygons, std::numbers::pi, ccw);
}

}  // namespace

void VertexBudget::take(std::size_t count, const Fields& fields) {
    if (count > limit - used)
        fields.fail("", "the scene's meshes exceed the limit of " + std::to_string(limit) +
                            " points, normals and indices");
    used += count;
}

bool is_mesh(std::string_view name) {
    return name == "IndexedFaceSet" || name == "IndexedTriangleSet" || name == "TriangleSet";
}

std::optional<TriangleMesh> read_mesh(const Element& geometry, const Placement& placement,
                                      Messages& messages, VertexBudget& budget) {
    const Fields fields(geometry, messages);
    const Properties properties = find_properties(geometry, messages);
    if (properties.coordinate == nullptr) {
        messages.warn(geometry.name, "without a Coordinate not drawn", geometry);
        return std::nullopt;
    }
    Polygons polygons;
    const Fields coordinate(*properties.coordinate, messages);
    polygons.points = coordinate.vectors("point");
    budget.take(polygons.points.size(), coordinate);
    const bool ccw = fields.boolean("ccw", true);
    if (geometry.name == "IndexedFaceSet")
        read_face_set(fields, ccw, properties.normal, messages, polygons, budget);
    else
        read_triangle_set(fields, geometry.name == "IndexedTriangleSet", ccw, properties.normal,
                          messages, polygons, budget);
    if (polygons.count() == 0) {
        messages.warn(geometry.name, "without triangles not drawn", geometry);
        return std::nullopt;
    }
    TriangleMesh mesh = to_mesh(std::move(polygons), placement, ccw);
    for (const Point3& p : mesh.positions)
        if (!is_finite(p)) coordinate.fail("point", "beyond the range of double in world space");
    if (placement.singular) messages.warn(geometry.name, "flattened by a scale of zero", geometry);
    return mesh;
}

}  // namespace nuvo::x3d
