#include "triangulation.h"

#include <geos_c.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace nuvo::x3d {

namespace {

using Point2 = Vec2<double>;

/// The corners of polygon i in the coordinate plane in which its area is largest, counterclockwise,
/// and scaled by a power of two (so exactly) to at most 2.
std::vector<Point2> in_plane(const Polygons& polygons, std::size_t i) {
    const Vector3 area = area_vector(polygons, i);
    const int axis = std::fabs(area.x) > std::fabs(area.y)
                         ? (std::fabs(area.x) > std::fabs(area.z) ? 0 : 2)
                         : (std::fabs(area.y) > std::fabs(area.z) ? 1 : 2);
    const int first = area[axis] < 0 ? (axis + 2) % 3 : (axis + 1) % 3;
    const int second = 3 - axis - first;
    double largest = 0;
    for (std::uint32_t c = polygons.ends[i]; c < polygons.ends[i + 1]; ++c)
        largest = std::fmax(largest, max_norm(polygons.points[polygons.corners[c]]));
    const int exponent = largest > 0 ? -std::ilogb(largest) : 0;
    std::vector<Point2> corners;
    for (std::uint32_t c = polygons.ends[i]; c < polygons.ends[i + 1]; ++c) {
        const Point3& p = polygons.points[polygons.corners[c]];
        corners.push_back({std::ldexp(p[first], exponent), std::ldexp(p[second], exponent)});
    }
    return corners;
}

/// How often a closed run of steps changes its direction along one axis.
template <typename Step>
int reversals(std::size_t count, Step step) {
    int last = 0, first = 0, changes = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double s = step(i);
        const int sign = s > 0 ? 1 : s < 0 ? -1 : 0;
        if (sign == 0) continue;
        if (last != 0 && sign != last) ++changes;
        if (first == 0) first = sign;
        last = sign;
    }
    return changes + (first != last ? 1 : 0);
}

/// True where every corner turns left and the whole goes round once.
bool is_convex(const std::vector<Point2>& p) {
    const std::size_t n = p.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Point2 &a = p[i], &b = p[(i + 1) % n], &c = p[(i + 2) % n];
        if (!((b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x) > 0)) return false;
    }
    return reversals(n, [&](std::size_t i) { return p[(i + 1) % n].x - p[i].x; }) <= 2 &&
           reversals(n, [&](std::size_t i) { return p[(i + 1) % n].y - p[i].y; }) <= 2;
}

/// The library's context; it says nothing, errors are null results.
class Geos {
  public:
    Geos() : handle_(GEOS_init_r()) {}
    ~Geos() { GEOS_finish_r(handle_); }
    Geos(const Geos&) = delete;
    Geos& operator=(const Geos&) = delete;

    /// The triangles of a polygon over the places of its corners, each in ascending order, which is
    /// the order in which the polygon turns; empty where it cannot be cut.
    std::vector<IndexTriple> triangulate(const std::vector<Point2>& corners) const {
        std::vector<double> ring;  // closed, and each corner's place as its z
        for (std::size_t i = 0; i <= corners.size(); ++i) {
            const std::size_t place = i % corners.size();
            ring.insert(ring.end(),
                        {corners[place].x, corners[place].y, static_cast<double>(place)});
        }
        GEOSCoordSequence* sequence = GEOSCoordSeq_copyFromBuffer_r(
            handle_, ring.data(), static_cast<unsigned>(corners.size() + 1), 1, 0);
        // Each takes over what it is given.
        const Geometry outline = own(GEOSGeom_createLinearRing_r(handle_, sequence));
        if (!outline) return {};
        const Geometry polygon = own(GEOSGeom_createPolygon_r(
            handle_, GEOSGeom_clone_r(handle_, outline.get()), nullptr, 0));
        if (!polygon) return {};
        const Geometry cut = own(GEOSConstrainedDelaunayTriangulation_r(handle_, polygon.get()));
        if (!cut) return {};
        std::vector<IndexTriple> triangles;
        for (int i = 0; i < GEOSGetNumGeometries_r(handle_, cut.get()); ++i)
            triangles.push_back(corners_of(GEOSGetGeometryN_r(handle_, cut.get(), i)));
        return triangles;
    }

  private:
    struct Destroy {
        GEOSContextHandle_t handle;
        void operator()(GEOSGeometry* geometry) const { GEOSGeom_destroy_r(handle, geometry); }
    };
    using Geometry = std::unique_ptr<GEOSGeometry, Destroy>;

    Geometry own(GEOSGeometry* geometry) const { return {geometry, Destroy{handle_}}; }

    IndexTriple corners_of(const GEOSGeometry* triangle) const {
        const GEOSCoordSequence* sequence =
            GEOSGeom_getCoordSeq_r(handle_, GEOSGetExteriorRing_r(handle_, triangle));
        IndexTriple corners{};
        for (unsigned c = 0; c < 3; ++c) {
            double place = 0;
            GEOSCoordSeq_getZ_r(handle_, sequence, c, &place);
            corners[c] = static_cast<std::uint32_t>(place);
        }
        std::sort(corners.begin(), corners.end());
        return corners;
    }

    GEOSContextHandle_t handle_;
};

}  // namespace

std::size_t cut_concave(Polygons& polygons,
                        const std::function<void(std::size_t corners)>& before_cut) {
    const Geos geos;
    std::vector<IndexTriple> cuts;
    cuts.reserve(polygons.corners.size() - 2 * polygons.count());
    bool any_cut = false;
    std::size_t uncut = 0;
    for (std::size_t i = 0; i < polygons.count(); ++i) {
        const std::uint32_t begin = polygons.ends[i];
        const std::uint32_t count = polygons.ends[i + 1] - begin;
        std::vector<IndexTriple> triangles;
        if (count > 3) {
            const std::vector<Point2> corners = in_plane(polygons, i);
            if (!is_convex(corners)) {
                before_cut(count);
                triangles = geos.triangulate(corners);
                if (triangles.empty() || triangles.size() > count - 2) {
                    triangles.clear();
                    ++uncut;
                } else {
                    any_cut = true;
                    triangles.resize(count - 2, IndexTriple{0, 0, 0});
                }
            }
        }
        if (triangles.empty())
            for (std::uint32_t c = 1; c + 1 < count; ++c) triangles.push_back({0, c, c + 1});
        for (const IndexTriple& t : triangles)
            cuts.push_back({begin + t[0], begin + t[1], begin + t[2]});
    }
    if (any_cut) polygons.cuts = std::move(cuts);
    return uncut;
}

}  // namespace nuvo::x3d
