#include "polygons.h"

#include <limits>

namespace nuvo::x3d {

namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

/// Drops the points that no corner uses, with the normals that belong to them.
void drop_unused_points(Polygons& polygons) {
    std::vector<std::uint32_t> place(polygons.points.size(), kUnused);
    std::size_t used = 0;
    for (const std::uint32_t corner : polygons.corners)
        if (place[corner] == kUnused) {
            place[corner] = 0;
            ++used;
        }
    if (used == polygons.points.size()) return;
    const bool normals_follow = !polygons.normals.empty() && polygons.corner_normals.empty();
    std::uint32_t next = 0;
    for (std::size_t p = 0; p < place.size(); ++p) {
        if (place[p] == kUnused) continue;
        polygons.points[next] = polygons.points[p];
        if (normals_follow) polygons.normals[next] = polygons.normals[p];
        place[p] = next++;
    }
    polygons.points.resize(next);
    polygons.points.shrink_to_fit();
    if (normals_follow) polygons.normals.resize(next);
    for (std::uint32_t& corner : polygons.corners) corner = place[corner];
}

/// The fans of `corners`, which belong to the polygons that end at `ends`.
std::vector<IndexTriple> fans(const std::vector<std::uint32_t>& corners,
                              const std::vector<std::uint32_t>& ends, bool swap) {
    std::vector<IndexTriple> triangles;
    triangles.reserve(corners.size() - 2 * (ends.size() - 1));
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
        for (std::uint32_t c = ends[i] + 1; c + 1 < ends[i + 1]; ++c)
            triangles.push_back(
                {corners[ends[i]], corners[swap ? c + 1 : c], corners[swap ? c : c + 1]});
    return triangles;
}

}  // namespace

TriangleMesh to_mesh(Polygons&& polygons, const Placement& placement, bool ccw) {
    drop_unused_points(polygons);
    // A mirror turns the winding round, and so does ccw="false"; both together leave it.
    const bool swap = placement.mirrored == ccw;
    TriangleMesh mesh;
    mesh.triangles = fans(polygons.corners, polygons.ends, swap);
    mesh.positions = std::move(polygons.points);
    for (Point3& p : mesh.positions) p = placement.to_world.point(p);
    if (placement.singular || polygons.normals.empty()) return mesh;
    mesh.normals = std::move(polygons.normals);
    for (Vector3& n : mesh.normals) n = placement.normal(n);
    if (!polygons.corner_normals.empty())
        mesh.normal_triangles = fans(polygons.corner_normals, polygons.ends, swap);
    return mesh;
}

}  // namespace nuvo::x3d
