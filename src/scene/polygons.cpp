#include "polygons.h"

#include <cmath>
#include <limits>

namespace nuvo::x3d {

namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

/// True for values that belong to the points themselves.
bool follows_points(const CornerValues& values) {
    return !values.values.empty() && values.corners.empty();
}

/// Drops the points that no corner uses, with the normals and colors that belong to them.
void drop_unused_points(Polygons& polygons) {
    std::vector<std::uint32_t> place(polygons.points.size(), kUnused);
    std::size_t used = 0;
    for (const std::uint32_t corner : polygons.corners)
        if (place[corner] == kUnused) {
            place[corner] = 0;
            ++used;
        }
    if (used == polygons.points.size()) return;
    std::vector<std::vector<Vector3>*> lists{&polygons.points};
    for (CornerValues* values : {&polygons.normals, &polygons.colors})
        if (follows_points(*values)) lists.push_back(&values->values);
    std::uint32_t next = 0;
    for (std::size_t p = 0; p < place.size(); ++p) {
        if (place[p] == kUnused) continue;
        for (std::vector<Vector3>* list : lists) (*list)[next] = (*list)[p];
        place[p] = next++;
    }
    for (std::vector<Vector3>* list : lists) {
        list->resize(next);
        list->shrink_to_fit();
    }
    for (std::uint32_t& corner : polygons.corners) corner = place[corner];
}

/// The triangles of the polygons over `indices`, which holds one index per corner.
std::vector<IndexTriple> triangles(const Polygons& polygons,
                                   const std::vector<std::uint32_t>& indices, bool swap) {
    std::vector<IndexTriple> result;
    const std::vector<std::uint32_t>& ends = polygons.ends;
    result.reserve(indices.size() - 2 * polygons.count());
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        result.push_back({indices[a], indices[swap ? c : b], indices[swap ? b : c]});
    };
    for (const IndexTriple& cut : polygons.cuts) add(cut[0], cut[1], cut[2]);
    if (!polygons.cuts.empty()) return result;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
        for (std::uint32_t c = ends[i] + 1; c + 1 < ends[i + 1]; ++c) add(ends[i], c, c + 1);
    return result;
}

}  // namespace

Vector3 area_vector(const Polygons& polygons, std::size_t i) {
    const std::uint32_t begin = polygons.ends[i];
    const std::uint32_t end = polygons.ends[i + 1];
    const Point3& first = polygons.points[polygons.corners[begin]];
    double size = 0;
    for (std::uint32_t c = begin + 1; c < end; ++c)
        size = std::fmax(size, max_norm(polygons.points[polygons.corners[c]] - first));
    Vector3 sum;
    // Edges are measured in the polygon's size: their products neither overflow nor vanish.
    for (std::uint32_t c = begin + 1; size > 0 && c + 1 < end; ++c)
        sum += cross((polygons.points[polygons.corners[c]] - first) / size,
                     (polygons.points[polygons.corners[c + 1]] - first) / size);
    return sum;
}

TriangleMesh to_mesh(Polygons&& polygons, const Placement& placement, bool ccw) {
    drop_unused_points(polygons);
    // A mirror turns the winding round, and so does ccw="false"; both together leave it.
    const bool swap = placement.mirrored == ccw;
    TriangleMesh mesh;
    mesh.triangles = triangles(polygons, polygons.corners, swap);
    mesh.positions = std::move(polygons.points);
    for (Point3& p : mesh.positions) p = placement.to_world.point(p);
    if (!polygons.colors.values.empty()) {
        mesh.colors = std::move(polygons.colors.values);
        if (!polygons.colors.corners.empty())
            mesh.color_triangles = triangles(polygons, polygons.colors.corners, swap);
    }
    if (placement.singular || polygons.normals.values.empty()) return mesh;
    mesh.normals = std::move(polygons.normals.values);
    for (Vector3& n : mesh.normals) n = placement.normal(n);
    if (!polygons.normals.corners.empty())
        mesh.normal_triangles = triangles(polygons, polygons.normals.corners, swap);
    return mesh;
}

}  // namespace nuvo::x3d
