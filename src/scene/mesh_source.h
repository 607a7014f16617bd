#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fields.h"
#include "polygons.h"

namespace nuvo::x3d {

/// Points, indices, normals and colors that the meshes of a scene may still read.
struct VertexBudget {
    std::size_t limit;
    std::size_t used = 0;

    /// Takes `count` of it; throws Error at the geometry `fields` when there is no more.
    void take(std::size_t count, const Fields& fields);
};

/// One geometry node while its polygons are gathered.
struct MeshSource {
    const Fields& fields;
    Messages& messages;
    VertexBudget& budget;
    const Element* coordinate = nullptr;  ///< property nodes; null where there is none
    const Element* normal = nullptr;
    const Element* color = nullptr;
    bool ccw = true;
    Polygons polygons;
    bool smooths_unasked = true;  ///< Defaults::smooths_unasked
};

/// `index` as a place in a list of `count` `what`s; throws Error at entry `entry` of `field`.
std::uint32_t checked(std::int64_t index, std::size_t count, const Fields& fields,
                      std::string_view field, std::size_t entry, const char* what);

/// How a list of values is spread over polygons (ISO/IEC 19775-1 clauses 11 and 13).
struct Spread {
    bool per_vertex = true;  ///< else one value per polygon
    Integers index;          ///< into the values; empty: by the points, or in order
    /// For polygons of an IndexedFaceSet: per polygon its number among all faces, and per corner
    /// its place in coordIndex. Empty: the polygons' own order.
    const std::vector<std::uint32_t>* faces = nullptr;
    const std::vector<std::uint32_t>* entries = nullptr;
};

/// Reads the Normal and the Color of a node, as far as it has them, and gives them to its polygons.
void read_normals(MeshSource& source, const Spread& spread);
void read_colors(MeshSource& source, const Spread& spread);

/// Generates normals below `crease_angle` and counts the work against the budget.
void smooth(MeshSource& source, double crease_angle);

/// A polygon of so many sides stays within r (1 - cos(pi / n)) of its circle: 0.29 pixels where the
/// radius is half the height of 1080 rows.
inline constexpr std::uint32_t kRoundSides = 96;

/// Cuts polygons of kRoundSides sides by halving, 96 sides to 48 to 24 to 12 to 6 to 3, and the
/// others as fans. A fan's 94 slivers at one corner would have the octree divide around it without
/// end.
void cut_round_polygons(Polygons& polygons);

/// Cuts the polygons into triangles where they may be concave; `field` in warnings is where their
/// corners come from.
void cut_polygons(MeshSource& source, std::string_view field);

// The readers of the geometry nodes: each appends its polygons, normals and colors.
void read_face_set(MeshSource& source);
void read_triangle_set(MeshSource& source);
void read_elevation_grid(MeshSource& source);
void read_extrusion(MeshSource& source);
void read_rectangle(MeshSource& source);
void read_disk(MeshSource& source);
void read_triangles_2d(MeshSource& source);
void read_box(MeshSource& source);
void read_cone(MeshSource& source);
void read_cylinder(MeshSource& source);

}  // namespace nuvo::x3d
