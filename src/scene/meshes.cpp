#include "meshes.h"

#include <unordered_map>

#include "node_names.h"

namespace nuvo::x3d {

namespace {

struct MeshKind {
    void (*read)(MeshSource&);
    bool has_coordinates = true;  // else the node's own fields say where its points are
    bool has_winding = true;      // a field ccw
};

const MeshKind* find_kind(std::string_view name) {
    static const std::unordered_map<std::string_view, MeshKind> kinds{
        {"Box", {read_box, false, false}},
        {"Cone", {read_cone, false, false}},
        {"Cylinder", {read_cylinder, false, false}},
        {"Disk2D", {read_disk, false, false}},
        {"ElevationGrid", {read_elevation_grid, false}},
        {"Extrusion", {read_extrusion, false}},
        {"IndexedFaceSet", {read_face_set}},
        {"IndexedQuadSet", {read_triangle_set}},
        {"IndexedTriangleFanSet", {read_triangle_set}},
        {"IndexedTriangleSet", {read_triangle_set}},
        {"IndexedTriangleStripSet", {read_triangle_set}},
        {"QuadSet", {read_triangle_set}},
        {"Rectangle2D", {read_rectangle, false, false}},
        {"TriangleFanSet", {read_triangle_set}},
        {"TriangleSet", {read_triangle_set}},
        {"TriangleSet2D", {read_triangles_2d, false, false}},
        {"TriangleStripSet", {read_triangle_set}},
    };
    const auto found = kinds.find(name);
    return found == kinds.end() ? nullptr : &found->second;
}

void find_properties(const Element& geometry, MeshSource& source) {
    for (const Element& child : geometry.children) {
        const std::string_view kind = child.kind();
        const bool is_coordinate = kind == "Coordinate" || kind == "CoordinateDouble";
        const bool is_color = kind == "Color" || kind == "ColorRGBA";
        if (is_coordinate && source.coordinate == nullptr)
            source.coordinate = &child.node();
        else if (kind == "Normal" && source.normal == nullptr)
            source.normal = &child.node();
        else if (is_color && source.color == nullptr)
            source.color = &child.node();
        else if (!is_silent(kind) && kind != "Appearance")  // of the Shape, if it has no other
            warn_not_drawn(child, source.messages);
    }
}

}  // namespace

bool is_mesh(std::string_view name) { return find_kind(name) != nullptr; }

std::optional<TriangleMesh> read_mesh(const Element& geometry, const Placement& placement,
                                      const ReadOptions& options, Messages& messages,
                                      VertexBudget& budget) {
    const MeshKind& kind = *find_kind(geometry.name);
    const Fields fields(geometry, messages, options.threads);
    MeshSource source{fields, messages, budget, nullptr, nullptr, nullptr, true, {}};
    find_properties(geometry, source);
    source.smooths_unasked = options.defaults.smooths_unasked;
    source.ccw = !kind.has_winding || fields.boolean("ccw", true);
    if (kind.has_coordinates) {
        if (source.coordinate == nullptr) {
            messages.warn(geometry.name, "without a Coordinate not drawn", geometry);
            return std::nullopt;
        }
        const Fields coordinate(*source.coordinate, messages, options.threads);
        source.polygons.points = coordinate.vectors("point");
        budget.take(source.polygons.points.size(), coordinate);
    }
    kind.read(source);
    if (source.polygons.count() == 0) {
        messages.warn(geometry.name, "without triangles not drawn", geometry);
        return std::nullopt;
    }
    TriangleMesh mesh = to_mesh(std::move(source.polygons), placement, source.ccw);
    for (const Point3& p : mesh.positions)
        if (!is_finite(p))
            Fields(source.coordinate != nullptr ? *source.coordinate : geometry, messages)
                .fail(kind.has_coordinates ? "point" : "",
                      "beyond the range of double in world space");
    if (placement.singular) messages.warn(geometry.name, "flattened by a scale of zero", geometry);
    return mesh;
}

}  // namespace nuvo::x3d
