#include <numbers>

#include "convexity.h"
#include "mesh_source.h"
#include "triangulation.h"

namespace nuvo::x3d {

namespace {

/// Where the polygons of an IndexedFaceSet stand in the file.
struct FaceNumbers {
    std::vector<std::uint32_t> face;  // per polygon: its number among all faces, short ones counted
    std::vector<std::uint32_t> entry;  // per corner: its place in coordIndex
    std::size_t concave = 0;           // polygons that claim to be convex and are not
};

/// Reads coordIndex, where -1 ends each face. Faces of fewer than three corners are left out.
FaceNumbers read_faces(MeshSource& source, bool convex) {
    const Fields& fields = source.fields;
    Polygons& polygons = source.polygons;
    const Integers indices = fields.integers("coordIndex");
    source.budget.take(indices.size(), fields);
    FaceNumbers numbers;
    polygons.corners.reserve(indices.size());
    numbers.entry.reserve(indices.size());
    std::uint32_t face = 0;
    std::size_t begin = 0;
    int plane = 0;
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
            if (convex && is_concave(polygons, polygons.count() - 1, plane)) ++numbers.concave;
        } else if (i > begin) {
            fields.warn("coordIndex", "with a face of fewer than three corners left out");
        }
        if (i > begin) ++face;
        begin = i + 1;
    }
    return numbers;
}

/// Appends the triangles of one strip or fan whose corners are `corner(0)` .. `corner(count - 1)`.
template <typename Corner>
void append_run(Polygons& polygons, bool strip, std::size_t count, Corner corner) {
    for (std::size_t i = 2; i < count; ++i) {
        const bool turned = strip && i % 2 == 1;
        const std::size_t first = strip ? i - 2 : 0;
        polygons.corners.push_back(corner(turned ? i - 1 : first));
        polygons.corners.push_back(corner(turned ? first : i - 1));
        polygons.corners.push_back(corner(i));
        polygons.end_polygon();
    }
}

/// A strip or fan of `count` corners.
template <typename Corner>
void append_checked_run(MeshSource& source, std::string_view field, bool strip, std::size_t count,
                        Corner corner) {
    if (count >= 3)
        append_run(source.polygons, strip, count, corner);
    else if (count > 0)
        source.fields.warn(field, "with fewer than three corners left out");
}

/// IndexedTriangleStripSet and IndexedTriangleFanSet: -1 ends each run.
void read_indexed_runs(MeshSource& source, bool strip) {
    const Fields& fields = source.fields;
    const Integers indices = fields.integers("index");
    source.budget.take(3 * indices.size(), fields);
    const std::size_t points = source.polygons.points.size();
    std::size_t begin = 0;
    for (std::size_t i = 0; i <= indices.size(); ++i) {
        if (i < indices.size() && indices[i] != -1) continue;
        append_checked_run(source, "index", strip, i - begin, [&](std::size_t c) {
            return checked(indices[begin + c], points, fields, "index", begin + c, "points");
        });
        begin = i + 1;
    }
}

/// TriangleStripSet and TriangleFanSet: each run takes the next so many points.
void read_counted_runs(MeshSource& source, bool strip) {
    const Fields& fields = source.fields;
    const char* field = strip ? "stripCount" : "fanCount";
    const std::size_t points = source.polygons.points.size();
    source.budget.take(3 * points, fields);
    std::size_t begin = 0;
    for (const std::int32_t count : fields.integers(field)) {
        if (count < 0 || static_cast<std::size_t>(count) > points - begin)
            fields.fail(field, "takes " + std::to_string(count) + " of " +
                                   std::to_string(points - begin) + " points that are left");
        append_checked_run(
            source, field, strip, static_cast<std::size_t>(count),
            [begin](std::size_t c) { return static_cast<std::uint32_t>(begin + c); });
        begin += static_cast<std::size_t>(count);
    }
    if (begin < points) fields.warn(field, "leaving points over");
}

/// Triangles or quadrilaterals of so many consecutive corners each; an incomplete last one is left
/// out.
void read_tuples(MeshSource& source, bool indexed, std::size_t corners) {
    const Fields& fields = source.fields;
    Polygons& polygons = source.polygons;
    Integers index;
    if (indexed) index = fields.integers("index");
    source.budget.take(index.size(), fields);
    const std::size_t points = polygons.points.size();
    const std::size_t count = indexed ? index.size() : points;
    polygons.corners.reserve(count);
    polygons.ends.reserve(count / corners + 1);
    for (std::size_t i = 0; i < count - count % corners; ++i) {
        polygons.corners.push_back(indexed ? checked(index[i], points, fields, "index", i, "points")
                                           : static_cast<std::uint32_t>(i));
        if ((i + 1) % corners == 0) polygons.end_polygon();
    }
    if (count % corners != 0)
        fields.warn(indexed ? "index" : "coord", corners == 3
                                                     ? "with an incomplete last triangle"
                                                     : "with an incomplete last quadrilateral");
}

}  // namespace

void cut_polygons(MeshSource& source, std::string_view field) {
    // Cutting n corners may cost n^2 steps: so many of them count as one point read.
    constexpr std::size_t kCornerPairs = 2;
    const std::size_t uncut = cut_concave(source.polygons, [&](std::size_t corners) {
        source.budget.take(corners * corners / kCornerPairs, source.fields);
    });
    if (uncut > 0)
        source.fields.warn(field, "with a polygon that crosses itself drawn as a fan", uncut);
}

void read_face_set(MeshSource& source) {
    const Fields& fields = source.fields;
    const double crease_angle = fields.number("creaseAngle", 0);
    const bool convex = fields.boolean("convex", true);
    const FaceNumbers numbers = read_faces(source, convex);
    const Spread normals{fields.boolean("normalPerVertex", true), fields.integers("normalIndex"),
                         &numbers.face, &numbers.entry};
    read_normals(source, normals);
    if (source.polygons.normals.values.empty() && normals.per_vertex) smooth(source, crease_angle);
    read_colors(source, {fields.boolean("colorPerVertex", true), fields.integers("colorIndex"),
                         &numbers.face, &numbers.entry});
    if (!convex) cut_polygons(source, "coordIndex");
    if (numbers.concave > 0)
        fields.warn("coordIndex",
                    "with a face that is not convex, which is undefined without convex='false', "
                    "drawn as a fan",
                    numbers.concave);
}

void read_triangle_set(MeshSource& source) {
    const Fields& fields = source.fields;
    const std::string_view kind = fields.element().name;
    const bool indexed = kind.starts_with("Indexed");
    const bool strip = kind.ends_with("StripSet");
    const bool runs = strip || kind.ends_with("FanSet");
    if (runs && indexed)
        read_indexed_runs(source, strip);
    else if (runs)
        read_counted_runs(source, strip);
    else
        read_tuples(source, indexed, kind.ends_with("QuadSet") ? 4 : 3);
    if (source.smooths_unasked || fields.has("normalPerVertex")) {
        const bool normal_per_vertex = fields.boolean("normalPerVertex", true);
        read_normals(source, {normal_per_vertex, {}});
        // The corners of a TriangleSet or QuadSet are points of their own: nothing is shared.
        if (source.polygons.normals.values.empty() && normal_per_vertex && (runs || indexed))
            smooth(source, std::numbers::pi);
    }
    if (!fields.boolean("colorPerVertex", true) && source.color != nullptr)
        fields.warn("colorPerVertex", "of false taken as true, as for all sets of triangles");
    read_colors(source, {});
}

}  // namespace nuvo::x3d
