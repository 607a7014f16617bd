#include <algorithm>
#include <cmath>
#include <cstdint>

#include "mesh_source.h"

namespace nuvo::x3d {

namespace {

/// The axes of a spine-aligned cross-section plane; the plane itself is spanned by x and z.
struct Axes {
    Vector3 x{1, 0, 0};
    Vector3 y{0, 1, 0};
    Vector3 z{0, 0, 1};
};

/// What an Extrusion's fields say.
struct Sweep {
    std::vector<Vector3> section;  // x, 0, z
    std::vector<Point3> spine;
    std::vector<Vector3> scale;  // x, 0, z
    std::vector<Matrix3> orientation;
    bool closed_section = false;
    bool closed_spine = false;
};

/// Of a list with one entry for each point of the spine, or fewer: then the last goes on.
template <typename T>
const T& entry(const std::vector<T>& list, std::size_t i) {
    return list[std::min(i, list.size() - 1)];
}

/// The nearest entry before, else behind, that is not zero replaces each zero; all stay zero where
/// none is.
void fill_zeros(std::vector<Vector3>& vectors) {
    const auto first = std::find_if(vectors.begin(), vectors.end(),
                                    [](const Vector3& v) { return v != Vector3{}; });
    if (first == vectors.end()) return;
    std::fill(vectors.begin(), first, *first);
    for (auto v = first + 1; v != vectors.end(); ++v)
        if (*v == Vector3{}) *v = *(v - 1);
}

/// The axes of a straight spine: the standard ones turned the shortest way onto its direction.
Axes straight_axes(const Vector3& direction) {
    const Vector3 up{0, 1, 0};
    if (direction == Vector3{} || direction == up) return {};
    const Vector3 across = cross(up, direction);
    if (across == Vector3{}) return {{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
    const Matrix3 turn = rotation(across, std::acos(std::clamp(direction.y, -1.0, 1.0)));
    return {turn.column(0), direction, turn.column(2)};
}

/// The axes at each point of the spine (ISO/IEC 19775-1, 13.3.5.4).
std::vector<Axes> spine_axes(const Sweep& sweep) {
    const std::vector<Point3>& s = sweep.spine;
    const std::size_t n = s.size();
    const auto direction = [&](std::size_t from, std::size_t to) {
        return normalized(s[to] - s[from]);
    };
    std::vector<Vector3> y(n), z(n);
    for (std::size_t i = 0; i < n; ++i) {
        const bool is_end = i == 0 || i + 1 == n;
        const bool wraps = is_end && sweep.closed_spine;
        const std::size_t before = wraps ? n - 2 : i == 0 ? 0 : i - 1;
        const std::size_t after = wraps ? 1 : i + 1 == n ? i : i + 1;
        y[i] = direction(before, after);
        // At the ends of an open spine z is its neighbour's.
        if (!is_end || wraps) z[i] = normalized(cross(direction(i, after), direction(i, before)));
    }
    fill_zeros(y);
    fill_zeros(z);
    std::vector<Axes> axes(n);
    const bool is_straight = z.front() == Vector3{};
    for (std::size_t i = 0; i < n; ++i) {
        if (is_straight) {
            axes[i] = straight_axes(y.front());
            continue;
        }
        if (i > 0 && dot(z[i], z[i - 1]) < 0) z[i] = -z[i];
        axes[i] = {normalized(cross(y[i], z[i])), y[i], z[i]};
    }
    return axes;
}

Sweep read_sweep(const Fields& fields) {
    Sweep sweep;
    sweep.section = fields.pairs("crossSection");
    if (sweep.section.empty())
        sweep.section = {{1, 0, 1}, {1, 0, -1}, {-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}};
    sweep.spine = fields.vectors("spine");
    if (sweep.spine.empty()) sweep.spine = {{0, 0, 0}, {0, 1, 0}};
    sweep.scale = fields.pairs("scale");
    if (sweep.scale.empty()) sweep.scale = {{1, 0, 1}};
    sweep.orientation = fields.rotations("orientation");
    if (sweep.orientation.empty()) sweep.orientation.emplace_back();
    for (const auto& [field, count] : {std::pair{"scale", sweep.scale.size()},
                                       std::pair{"orientation", sweep.orientation.size()}})
        if (count > 1 && count < sweep.spine.size())
            fields.warn(field, "with fewer entries than the spine has points: the last goes on");
    sweep.closed_section =
        sweep.section.size() > 2 && sweep.section.front() == sweep.section.back();
    sweep.closed_spine = sweep.spine.size() > 2 && sweep.spine.front() == sweep.spine.back();
    return sweep;
}

void append_cap(Polygons& polygons, std::uint32_t row, std::uint32_t corners, bool is_end) {
    // Points of its own: a cap never smooths into the sides.
    const auto first = static_cast<std::uint32_t>(polygons.points.size());
    for (std::uint32_t c = 0; c < corners; ++c) {
        const Point3 point = polygons.points[row + c];
        polygons.points.push_back(point);
    }
    for (std::uint32_t c = 0; c < corners; ++c)
        polygons.corners.push_back(first + (is_end ? c : corners - 1 - c));
    polygons.end_polygon();
}

/// Appends one ring of points for each point of the spine.
void append_rings(const Sweep& sweep, std::size_t corners, Polygons& polygons) {
    const std::vector<Axes> axes = spine_axes(sweep);
    for (std::size_t i = 0; i < sweep.spine.size(); ++i) {
        const Matrix3& turn = entry(sweep.orientation, i);
        const Vector3& scale = entry(sweep.scale, i);
        for (std::size_t c = 0; c < corners; ++c) {
            const Vector3& p = sweep.section[c];
            const Vector3 local = turn * Vector3{p.x * scale.x, 0, p.z * scale.z};
            polygons.points.push_back(sweep.spine[i] + axes[i].x * local.x + axes[i].y * local.y +
                                      axes[i].z * local.z);
        }
    }
}

}  // namespace

void read_extrusion(MeshSource& source) {
    const Fields& fields = source.fields;
    const Sweep sweep = read_sweep(fields);
    Polygons& polygons = source.polygons;
    const std::size_t rows = sweep.spine.size();
    const std::size_t sides = sweep.section.size() - 1;
    const std::size_t corners = sweep.closed_section ? sides : sides + 1;
    source.budget.take(corners * (rows + 2) + 4 * sides * rows + 2 * corners, fields);
    append_rings(sweep, corners, polygons);
    // A closed spine whose last ring lies on the first has a smooth seam.
    const auto size = static_cast<std::ptrdiff_t>(corners);
    const bool seam =
        sweep.closed_spine && std::equal(polygons.points.begin(), polygons.points.begin() + size,
                                         polygons.points.end() - size);
    const auto point = [&](std::size_t row, std::size_t corner) {
        const std::size_t r = seam && row + 1 == rows ? 0 : row;
        return static_cast<std::uint32_t>(r * corners + corner % corners);
    };
    for (std::size_t r = 0; r + 1 < rows; ++r)
        for (std::size_t c = 0; c < sides; ++c) {
            for (const std::uint32_t corner :
                 {point(r, c), point(r, c + 1), point(r + 1, c + 1), point(r + 1, c)})
                polygons.corners.push_back(corner);
            polygons.end_polygon();
        }
    if (corners >= 3 && rows > 1) {
        const auto n = static_cast<std::uint32_t>(corners);
        if (fields.boolean("beginCap", true)) append_cap(polygons, 0, n, false);
        if (fields.boolean("endCap", true))
            append_cap(polygons, static_cast<std::uint32_t>((rows - 1) * corners), n, true);
    }
    smooth(source, fields.number("creaseAngle", 0));
    if (!fields.boolean("convex", true)) cut_polygons(source, "crossSection");
}

}  // namespace nuvo::x3d
