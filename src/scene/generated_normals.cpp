#include <cmath>
#include <numbers>

#include "polygons.h"

namespace nuvo::x3d {

namespace {

/// The unit normal of each polygon on the side from which it is seen counterclockwise (clockwise if
/// `ccw` is false): the sum of its fan's cross products. Zero for a polygon without area.
std::vector<Vector3> face_normals(const Polygons& polygons, bool ccw) {
    std::vector<Vector3> normals;
    normals.reserve(polygons.count());
    for (std::size_t i = 0; i < polygons.count(); ++i) {
        const Vector3 normal = normalized(area_vector(polygons, i));
        normals.push_back(ccw ? normal : -normal);
    }
    return normals;
}

/// For every point the polygons that meet there, each once and in order: those of point p are
/// polygon[first[p]] .. polygon[first[p + 1] - 1].
struct Adjacency {
    std::vector<std::uint32_t> first;
    std::vector<std::uint32_t> polygon;
};

/// Calls visit(point, polygon) once for every polygon and every distinct point of it.
template <typename Visit>
void for_each_incidence(const Polygons& polygons, Visit visit) {
    std::vector<std::uint32_t> last_seen(polygons.points.size(), 0);  // polygon + 1
    for (std::uint32_t i = 0; i < polygons.count(); ++i)
        for (std::uint32_t c = polygons.ends[i]; c < polygons.ends[i + 1]; ++c) {
            const std::uint32_t point = polygons.corners[c];
            if (last_seen[point] == i + 1) continue;
            last_seen[point] = i + 1;
            visit(point, i);
        }
}

Adjacency adjacency(const Polygons& polygons) {
    Adjacency result;
    result.first.assign(polygons.points.size() + 1, 0);
    for_each_incidence(polygons,
                       [&](std::uint32_t point, std::uint32_t) { ++result.first[point + 1]; });
    for (std::size_t p = 1; p < result.first.size(); ++p) result.first[p] += result.first[p - 1];
    result.polygon.resize(result.first.back());
    std::vector<std::uint32_t> next = result.first;
    for_each_incidence(polygons, [&](std::uint32_t point, std::uint32_t polygon) {
        result.polygon[next[point]++] = polygon;
    });
    return result;
}

/// One normal per point. Where the faces at a point cancel out, its corners keep their own faces'.
void smooth_all(Polygons& polygons, const std::vector<Vector3>& faces) {
    polygons.normals.values.assign(polygons.points.size(), {});
    for_each_incidence(polygons, [&](std::uint32_t point, std::uint32_t polygon) {
        polygons.normals.values[point] += faces[polygon];
    });
    for (Vector3& normal : polygons.normals.values) normal = normalized(normal);
    const std::size_t shared = polygons.normals.values.size();
    for (std::size_t i = 0; i < polygons.count(); ++i)
        for (std::uint32_t c = polygons.ends[i]; c < polygons.ends[i + 1]; ++c) {
            if (polygons.normals.values[polygons.corners[c]] != Vector3{}) continue;
            if (polygons.normals.corners.empty()) polygons.normals.corners = polygons.corners;
            polygons.normals.corners[c] =
                static_cast<std::uint32_t>(polygons.normals.values.size());
            polygons.normals.values.push_back(faces[i]);
        }
    if (polygons.normals.values.size() == shared) polygons.normals.corners.clear();
}

/// One normal per corner.
void smooth_below(Polygons& polygons, const std::vector<Vector3>& faces, double crease_angle) {
    const Adjacency around = adjacency(polygons);
    const double cosine = std::cos(crease_angle);
    polygons.normals.values.reserve(polygons.corners.size());
    polygons.normals.corners.reserve(polygons.corners.size());
    for (std::uint32_t i = 0; i < polygons.count(); ++i)
        for (std::uint32_t c = polygons.ends[i]; c < polygons.ends[i + 1]; ++c) {
            const std::uint32_t point = polygons.corners[c];
            Vector3 sum;
            for (std::uint32_t a = around.first[point]; a < around.first[point + 1]; ++a) {
                const std::uint32_t other = around.polygon[a];
                if (other == i || dot(faces[i], faces[other]) > cosine) sum += faces[other];
            }
            const Vector3 normal = normalized(sum);
            polygons.normals.corners.push_back(c);
            polygons.normals.values.push_back(normal == Vector3{} ? faces[i] : normal);
        }
}

}  // namespace

void generate_normals(Polygons& polygons, double crease_angle, bool ccw) {
    polygons.normals.values.clear();
    polygons.normals.corners.clear();
    if (!(crease_angle > 0)) return;
    const std::vector<Vector3> faces = face_normals(polygons, ccw);
    if (crease_angle >= std::numbers::pi)
        smooth_all(polygons, faces);
    else
        smooth_below(polygons, faces, crease_angle);
}

}  // namespace nuvo::x3d
