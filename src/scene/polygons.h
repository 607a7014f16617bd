#pragma once

#include <cstdint>
#include <vector>

#include "nuvo/geometry/triangle_mesh.h"
#include "placement.h"

namespace nuvo::x3d {

/// Normals or colors of polygons.
struct CornerValues {
    std::vector<Vector3> values;         ///< empty: none
    std::vector<std::uint32_t> corners;  ///< into values, one per corner; empty: same as the points
};

/// The polygons of one geometry node in its own coordinates, as the file lists them.
struct Polygons {
    std::vector<Point3> points;
    std::vector<std::uint32_t> corners;  ///< into points, polygon after polygon
    std::vector<std::uint32_t> ends{0};  ///< polygon i has the corners [ends[i], ends[i + 1])
    CornerValues normals;                ///< for shading; none: flat
    CornerValues colors;
    /// Triangles over places in `corners`, n - 2 for each polygon of n corners, polygon after
    /// polygon; empty: every polygon is a fan.
    std::vector<IndexTriple> cuts;

    std::size_t count() const { return ends.size() - 1; }
    /// Ends the polygon whose corners have been appended.
    void end_polygon() { ends.push_back(static_cast<std::uint32_t>(corners.size())); }
};

/// The sum of the cross products of polygon i's fan, in units of the polygon's own size: it points
/// to the side from which the polygon is seen counterclockwise. Zero for one without area.
Vector3 area_vector(const Polygons& polygons, std::size_t i);

/// Gives the polygons the shading normals that X3D generates: at each corner the normalised plain
/// sum of the unit normals of the polygons that meet at the point and whose normal is less than
/// `crease_angle` (radians) from the corner's own polygon's. From pi on all are summed; at 0 and
/// below the polygons stay flat. `ccw` false turns the normals round.
void generate_normals(Polygons& polygons, double crease_angle, bool ccw);

/// The polygons as triangles, fans (0, i, i + 1) or as they are cut, in world space, without unused
/// points; wound so that (b - a) x (c - a) is the geometric normal. Under a singular placement the
/// mesh is flat.
TriangleMesh to_mesh(Polygons&& polygons, const Placement& placement, bool ccw);

}  // namespace nuvo::x3d
