// Every geometry node, as the grammar makes it.
#include <array>
#include <cmath>

#include "parts.h"

namespace nuvo::fuzz {
namespace {

using Points = std::vector<Point3>;

Element coordinates(const Points& points) {
    std::string list;
    for (const Point3& p : points) list += (list.empty() ? "" : ", ") + text(p);
    return {"Coordinate", {{"point", list}}, {}};
}

// Corners anywhere: on a lattice, in a plane or line, on a sphere, repeated, nearly repeated.
Points any_points(Chooser& choose, int count) {
    Points points;
    const int flat = choose.below(12);
    for (int i = 0; i < count; ++i) {
        Point3 p = choose.point(2.5);
        if (flat < 3) p[flat] = 0;
        if (flat == 3) p = Point3{} + normalized(p) * 2;
        if (flat == 4) p.z = p.x + p.y;
        if (i > 0 && choose.once_in(10)) {
            p = points[static_cast<std::size_t>(choose.below(i))];
            for (int axis = 0; axis < 3; ++axis) p[axis] = choose.nearly(p[axis]);
        }
        points.push_back(p);
    }
    return points;
}

std::string any_indices(Chooser& choose, int points, int count) {
    std::string list;
    for (int i = 0; i < count; ++i)
        list += (i > 0 ? " " : "") + std::to_string(choose.below(points));
    return list;
}

void maybe_colors(Chooser& choose, Element& mesh, int points) {
    if (!choose.once_in(6)) return;
    std::string list;
    for (int i = 0; i < points; ++i) list += choose.color() + ", ";
    mesh.add({"Color", {{"color", list}}, {}});
}

void maybe_normals(Chooser& choose, Element& mesh, int points) {
    if (!choose.once_in(6)) return;
    std::string list;
    for (int i = 0; i < points; ++i) list += text(choose.direction()) + ", ";
    mesh.add({"Normal", {{"vector", list}}, {}});
}

Element face_set(Chooser& choose) {
    const int points = 3 + choose.below(10);
    std::string index;
    for (int face = 1 + choose.below(6); face > 0; --face)
        index +=
            any_indices(choose, points, 3 + (choose.once_in(3) ? choose.below(3) : 0)) + " -1 ";
    Element mesh{"IndexedFaceSet", {{"coordIndex", index}}, {}};
    constexpr const char* kAngles[] = {"0", "0.5", "1.5707963267948966", "3.2", "1e-300"};
    if (choose.once_in(3)) mesh.set("creaseAngle", choose.one_of(kAngles));
    if (choose.once_in(4)) mesh.set("convex", "false");
    mesh.add(coordinates(any_points(choose, points)));
    maybe_colors(choose, mesh, points);
    return mesh;
}

// Faces around one tip, as of a cone.
Element fan(Chooser& choose) {
    const int sides = 3 + choose.below(choose.once_in(4) ? 60 : 8);
    Points points{choose.point(1)};
    std::string index;
    const double radius = choose.size();
    const double height = choose.once_in(3) ? 0 : choose.size();
    for (int i = 0; i < sides; ++i) {
        const double turn = 6.283185307179586 * i / sides;
        points.push_back({radius * std::cos(turn), -height, radius * std::sin(turn)});
        index += "0 " + std::to_string(i + 1) + " " + std::to_string((i + 1) % sides + 1) + " -1 ";
    }
    Element mesh{"IndexedFaceSet", {{"coordIndex", index}}, {}};
    if (choose.once_in(2)) mesh.set("creaseAngle", "2");
    return mesh.add(coordinates(points));
}

Element triangles(Chooser& choose) {
    constexpr std::array<const char*, 10> kKinds{"TriangleSet",
                                                 "IndexedTriangleSet",
                                                 "TriangleStripSet",
                                                 "TriangleFanSet",
                                                 "QuadSet",
                                                 "IndexedQuadSet",
                                                 "IndexedTriangleStripSet",
                                                 "IndexedTriangleFanSet",
                                                 "IndexedTriangleSet",
                                                 "IndexedTriangleSet"};
    const std::string kind = kKinds[static_cast<std::size_t>(choose.below(kKinds.size()))];
    const int corners = kind.find("Quad") != std::string::npos ? 4 : 3;
    const int points = corners * (1 + choose.below(4));
    Element mesh{kind, {}, {}};
    if (kind.rfind("Indexed", 0) == 0)
        mesh.set("index", any_indices(choose, points, corners * (1 + choose.below(5))));
    if (kind == "TriangleStripSet") mesh.set("stripCount", std::to_string(points));
    if (kind == "TriangleFanSet") mesh.set("fanCount", std::to_string(points));
    if (choose.once_in(4)) mesh.set("normalPerVertex", "false");
    mesh.add(coordinates(any_points(choose, points)));
    maybe_colors(choose, mesh, points);
    maybe_normals(choose, mesh, points);
    return mesh;
}

Element elevation_grid(Chooser& choose) {
    const int columns = 2 + choose.below(4);
    const int rows = 2 + choose.below(4);
    Element grid{"ElevationGrid",
                 {{"xDimension", std::to_string(columns)}, {"zDimension", std::to_string(rows)}},
                 {}};
    std::string heights;
    const bool flat = choose.once_in(4);
    for (int i = 0; i < columns * rows; ++i) heights += text(flat ? 0 : choose.coordinate(1)) + " ";
    grid.set("height", heights);
    if (choose.once_in(2)) grid.set("xSpacing", text(choose.size()));
    if (choose.once_in(3)) grid.set("creaseAngle", "1");
    return grid;
}

Element box(Chooser& choose) {
    Element box{"Box", {}, {}};
    if (!choose.once_in(3)) {
        Vector3 size{choose.size(), choose.size(), choose.size()};
        constexpr double kThin[] = {0.1, 1e-3, 1e-9, 0, 10};
        if (choose.once_in(3)) size[choose.below(3)] = choose.one_of(kThin);
        box.set("size", text(size));
    }
    return box;
}

// Cylinders and Cones; they have hundreds of triangles.
Element round_solid(Chooser& choose) {
    const bool cone = choose.once_in(2);
    Element solid{cone ? "Cone" : "Cylinder", {}, {}};
    if (choose.once_in(2)) solid.set(cone ? "bottomRadius" : "radius", text(choose.size()));
    if (choose.once_in(2)) solid.set("height", text(choose.size()));
    if (choose.once_in(4)) solid.set("bottom", "false");
    if (choose.once_in(6)) solid.set("side", "false");
    return solid;
}

}  // namespace

Element any_mesh(Chooser& choose) {
    Element mesh = choose.once_in(4)   ? face_set(choose)
                   : choose.once_in(3) ? fan(choose)
                   : choose.once_in(6) ? elevation_grid(choose)
                                       : triangles(choose);
    if (choose.once_in(3)) mesh.set("solid", "false");
    if (choose.once_in(8)) mesh.set("ccw", "false");
    return mesh;
}

Element any_shape(Chooser& choose, bool tip_heavy) {
    if (tip_heavy && !choose.once_in(4))
        return shape_of(choose, choose.once_in(3) ? round_solid(choose) : fan(choose));
    switch (choose.below(12)) {
        case 0:
        case 1:
        case 2:
        case 3:
            return shape_of(choose, sphere(choose));
        case 4:
        case 5:
        case 6:
            return shape_of(choose, box(choose));
        case 7:
            if (choose.once_in(3)) return shape_of(choose, round_solid(choose));
            [[fallthrough]];
        default:
            return shape_of(choose, any_mesh(choose));
    }
}

}  // namespace nuvo::fuzz
