#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "nuvo/math/bounds.h"
#include "nuvo/math/vec.h"

namespace nuvo {

using IndexTriple = std::array<std::uint32_t, 3>;

/// Three corners; seen counterclockwise from the side its geometric normal points to.
struct Triangle {
    Point3 a;
    Point3 b;
    Point3 c;

    constexpr Bounds3 bounds() const { return Bounds3{a, a}.extended(b).extended(c); }
};

/// Triangles over shared corners, in world space. [thesis 5.2.2]
/// The list keeps the file's order and also its zero-area triangles (which are never hit), so that
/// a triangle's index is its place in the file. Winding is already turned so that (b - a) x (c - a)
/// is the geometric normal, whatever `ccw` and the transform's sign said.
struct TriangleMesh {
    std::vector<Point3> positions;
    std::vector<IndexTriple> triangles;
    std::vector<Vector3> normals;               ///< world space, not necessarily unit; empty: flat
    std::vector<IndexTriple> normal_triangles;  ///< into normals; empty: same as `triangles`
    std::vector<Vector3> colors;                ///< in place of the material's; empty: none
    std::vector<IndexTriple> color_triangles;   ///< into colors; empty: same as `triangles`

    Triangle triangle(std::size_t i) const {
        const IndexTriple& v = triangles[i];
        return {positions[v[0]], positions[v[1]], positions[v[2]]};
    }
    Bounds3 bounds() const;
};

/// True when the triangle's area is exactly zero (corners on one line or coinciding).
bool has_zero_area(const Triangle& triangle);

}  // namespace nuvo
