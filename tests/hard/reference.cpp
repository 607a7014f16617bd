#include "reference.h"

#include <algorithm>
#include <cmath>

namespace nuvo::hard {
namespace {

using Long = Vec3<long double>;

// Below this, relative to what was summed up, a number of 60 digits made from doubles is 0: sums
// of products of three doubles that are not 0 are larger.
const Digits& none() {
    static const Digits value("1e-45");
    return value;
}
// Nearer to the lit point than this part of the shadow ray lies only what touches it.
const Digits& touch() {
    static const Digits value("1e-30");
    return value;
}

// The same for the light, whose place is not computed: a light in doubles may be as near to a
// sphere as 1e-32 and not touch it.
const Digits& touch_of_light() {
    static const Digits value("1e-40");
    return value;
}

Digits size(const DigitsVector& v) {
    return Digits(abs(v.x)) + Digits(abs(v.y)) + Digits(abs(v.z));
}
Long rounded(const DigitsVector& v) {
    return {static_cast<long double>(v.x), static_cast<long double>(v.y),
            static_cast<long double>(v.z)};
}
Digits along_normal(const DigitsVector& v, const Triangle& t) {
    const DigitsVector a(t.a);
    return dot(v, cross(DigitsVector(t.b) - a, DigitsVector(t.c) - a));
}
DigitsVector unit(const DigitsVector& v) { return v / Digits(sqrt(dot(v, v))); }

// The inverse's columns: M^-1 v = x . v and so on, for the rows x, y, z returned.
struct Inverse {
    DigitsVector row[3];
    explicit Inverse(const Matrix3& m) {
        const DigitsVector a(m.column(0));
        const DigitsVector b(m.column(1));
        const DigitsVector c(m.column(2));
        const Digits determinant = dot(a, cross(b, c));
        row[0] = cross(b, c) / determinant;
        row[1] = cross(c, a) / determinant;
        row[2] = cross(a, b) / determinant;
    }
    DigitsVector operator*(const DigitsVector& v) const {
        return {dot(row[0], v), dot(row[1], v), dot(row[2], v)};
    }
    DigitsVector transposed(const DigitsVector& v) const {
        return row[0] * v.x + row[1] * v.y + row[2] * v.z;
    }
};

std::uint8_t channel(long double v) {
    return static_cast<std::uint8_t>(std::floor(std::clamp(v, 0.0L, 1.0L) * 255 + 0.5L));
}

}  // namespace

Reference::Reference(const Scene& scene, Resolution resolution)
    : scene_(scene), resolution_(resolution), sieve_(scene) {
    const Digits half = tan(Digits(scene.camera.field_of_view_rad) / 2);
    const int smaller = std::min(resolution.width, resolution.height);
    half_width_ = half * resolution.width / smaller;
    half_height_ = half * resolution.height / smaller;
    for (const Object& object : scene.objects) {
        const Bounds3 box = bounds(object.shape);
        largest_ = std::max({largest_, max_norm(box.min), max_norm(box.max)});
    }
}

Reference::Line Reference::line(double x, double y) const {
    const Camera& camera = scene_.camera;
    const Digits across = (2 * Digits(x) / resolution_.width - 1) * half_width_;
    const Digits upwards = (1 - 2 * Digits(y) / resolution_.height) * half_height_;
    return {DigitsVector(camera.position),
            unit(DigitsVector(camera.right) * across + DigitsVector(camera.up) * upwards +
                 DigitsVector(camera.forward))};
}

std::optional<DigitsVector> Reference::plane(const Line& line, const Triangle& triangle) {
    const DigitsVector a(triangle.a);
    const DigitsVector e1 = DigitsVector(triangle.b) - a;
    const DigitsVector e2 = DigitsVector(triangle.c) - a;
    const DigitsVector p = cross(line.direction, e2);
    const Digits determinant = dot(e1, p);
    if (abs(determinant) <= none() * size(e1) * size(e2) * size(line.direction))
        return std::nullopt;
    const DigitsVector s = line.origin - a;
    const DigitsVector q = cross(s, e1);
    const Digits v = dot(s, p) / determinant;
    const Digits w = dot(line.direction, q) / determinant;
    const Digits edge = none() * (1 + size(s) / std::min(size(e1), size(e2)));
    if (v < -edge || w < -edge || v + w > 1 + edge) return std::nullopt;
    return DigitsVector{dot(e2, q) / determinant, v, w};
}

std::optional<Reference::Roots> Reference::roots(const Line& line, const Shape& shape) {
    DigitsVector f;
    DigitsVector g = line.direction;
    Digits r;
    if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        f = line.origin - DigitsVector(sphere->center);
        r = sphere->radius;
    } else {
        const auto& ellipsoid = std::get<Ellipsoid>(shape);
        const Inverse inverse(ellipsoid.linear);
        f = inverse * (line.origin - DigitsVector(ellipsoid.center));
        g = inverse * g;
        r = ellipsoid.radius;
    }
    const Digits a = dot(g, g);
    const Digits b = dot(f, g);
    const Digits c = dot(f, f) - r * r;
    const Digits discriminant = b * b - a * c;
    if (discriminant < 0) return std::nullopt;
    const Digits surd = sqrt(discriminant);
    const Digits large = b < 0 ? surd - b : -surd - b;
    if (large == 0) return Roots{0, 0};
    return b < 0 ? Roots{c / large, large / a} : Roots{large / a, c / large};
}

std::optional<Reference::Meeting> Reference::nearest(const Line& line) const {
    constexpr long double kSlack = 1e-13L;  // the line in 64 bits, and more
    std::optional<Meeting> best;
    const auto take = [&](std::size_t object, std::size_t triangle, const Digits& t) {
        if (!(t > 0) || (best && t >= best->t * (1 - none()))) return;
        best = Meeting{object, triangle, t, {}, {}, {}, {}};
    };
    sieve_.each(rounded(line.origin), rounded(line.direction), kSlack,
                [&](std::size_t object, std::size_t triangle) {
                    const Shape& shape = scene_.objects[object].shape;
                    const bool solid = scene_.objects[object].solid;
                    if (const auto* mesh = std::get_if<TriangleMesh>(&shape)) {
                        const Triangle t = mesh->triangle(triangle);
                        const auto at = plane(line, t);
                        if (at && !(solid && along_normal(line.direction, t) > 0))
                            take(object, triangle, at->x);
                    } else if (const auto found = roots(line, shape)) {
                        take(object, triangle,
                             found->first > 0 || solid ? found->first : found->second);
                    }
                });
    if (best) finish(line, *best);
    return best;
}

// The point and the normals.
void Reference::finish(const Line& line, Meeting& meeting) const {
    const Object& object = scene_.objects[meeting.object];
    meeting.point = line.origin + line.direction * meeting.t;
    DigitsVector geometric;
    if (const auto* mesh = std::get_if<TriangleMesh>(&object.shape)) {
        const Triangle t = mesh->triangle(meeting.triangle);
        const DigitsVector e1 = DigitsVector(t.b) - DigitsVector(t.a);
        const DigitsVector e2 = DigitsVector(t.c) - DigitsVector(t.a);
        const DigitsVector at = *plane(line, t);
        // In the plane even where the last of the 60 digits is rounded.
        meeting.point = DigitsVector(t.a) + (e1 * at.y + e2 * at.z);
        geometric = cross(e1, e2);
        meeting.geometric = meeting.shading = rounded(unit(geometric));
        const auto v = static_cast<long double>(at.y);
        const auto w = static_cast<long double>(at.z);
        const auto blended = [&](const auto& values, const auto& own_corners) {
            const auto& corners = own_corners.empty() ? mesh->triangles : own_corners;
            const IndexTriple& n = corners[meeting.triangle];
            return Long(values[n[0]]) * (1 - v - w) + Long(values[n[1]]) * v +
                   Long(values[n[2]]) * w;
        };
        if (!mesh->normals.empty()) {
            const Long normal = blended(mesh->normals, mesh->normal_triangles);
            if (length(normal) > 0) meeting.shading = normal / length(normal);
        }
        if (!mesh->colors.empty()) meeting.color = blended(mesh->colors, mesh->color_triangles);
    } else if (const auto* sphere = std::get_if<Sphere>(&object.shape)) {
        meeting.geometric = rounded(unit(meeting.point - DigitsVector(sphere->center)));
        meeting.shading = meeting.geometric;
    } else {
        const auto& ellipsoid = std::get<Ellipsoid>(object.shape);
        const Inverse inverse(ellipsoid.linear);
        const DigitsVector local = inverse * (meeting.point - DigitsVector(ellipsoid.center));
        meeting.geometric = rounded(unit(inverse.transposed(local)));
        meeting.shading = meeting.geometric;
    }
    if (!object.solid && dot(meeting.geometric, rounded(line.direction)) > 0)
        meeting.shading = -meeting.shading;
}

// [definition 4]
bool Reference::blocked(const Meeting& meeting, const Line& shadow, bool endless) const {
    constexpr long double kSlack = 1e-13L;
    const Digits least =
        endless ? Digits(touch() * size(meeting.point) + touch() * meeting.t) : touch();
    const auto between = [&](const Digits& t) {
        return t > least && (endless || t < 1 - touch_of_light());
    };
    bool found = false;
    sieve_.each(rounded(shadow.origin), rounded(shadow.direction), kSlack,
                [&](std::size_t object, std::size_t triangle) {
                    if (found) return;
                    const Shape& shape = scene_.objects[object].shape;
                    const bool solid = scene_.objects[object].solid;
                    if (!scene_.objects[object].casts_shadow) return;
                    // The light sees the front of what the way to it leaves.
                    if (const auto* mesh = std::get_if<TriangleMesh>(&shape)) {
                        if (object == meeting.object && triangle == meeting.triangle) return;
                        const Triangle t = mesh->triangle(triangle);
                        const auto at = plane(shadow, t);
                        found = at && between(at->x) &&
                                !(solid && along_normal(shadow.direction, t) < 0);
                    } else if (const auto two = roots(shadow, shape)) {
                        found = (!solid && between(two->first)) || between(two->second);
                    }
                });
    return found;
}

bool Reference::stable(int x, int y) const {
    const Sample middle = pixel(x, y);
    for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy)
            if (!sample(x + 0.5 + dx * 1e-3, y + 0.5 + dy * 1e-3).sees_the_same(middle))
                return false;
    return true;
}

// A light lies in the plane of the lit surface at that point, up to rounding.
bool Reference::lit_along_the_surface(int x, int y) const {
    const std::optional<Meeting> meeting = nearest(line(x + 0.5, y + 0.5));
    if (!meeting) return false;
    const auto& n = meeting->geometric;
    return std::any_of(scene_.lights.begin(), scene_.lights.end(), [&](const Light& light) {
        const bool endless = light.kind == Light::Kind::kDirectional;
        const Long way =
            endless ? Long(light.direction) : Long(light.location) - rounded(meeting->point);
        return std::fabs(dot(n, way)) <= 0x1p-41L * (endless ? 1 : largest_);
    });
}

bool Reference::stable_when_rounded(int x, int y) const {
    if (lit_along_the_surface(x, y)) return false;
    // From less than a rounding of a coordinate to the worst that a lit point may have.
    constexpr double kErrors[] = {0x1p-55, 0x1p-53, 0x1p-50, 0x1p-46, 0x1p-41};
    const Sample exact = pixel(x, y);
    for (const double e : kErrors)
        for (int i = 0; i < 8; ++i) {
            const Vector3 error{i & 1 ? e : -e, i & 2 ? e : -e, i & 4 ? e : -e};
            if (!sample(x + 0.5, y + 0.5, error).sees_the_same(exact)) return false;
        }
    return true;
}

Reference::Sample Reference::sample(double x, double y, const Vector3& error) const {
    const Line ray = line(x, y);
    std::optional<Meeting> meeting = nearest(ray);
    if (meeting) meeting->point = meeting->point + DigitsVector(error * largest_);
    Sample sample;
    Long color;
    if (!meeting) {
        color = background(rounded(ray.direction));
    } else {
        const Object& object = scene_.objects[meeting->object];
        const Material& material = scene_.materials[object.material];
        color = emitted(*meeting);
        for (std::size_t i = 0; material.lit && i < scene_.lights.size(); ++i) {
            const Light& source = scene_.lights[i];
            if (!source.scope.includes(static_cast<std::uint32_t>(meeting->object))) continue;
            const auto added = light(source, *meeting, -rounded(ray.direction));
            if (!added) continue;
            const bool endless = source.kind == Light::Kind::kDirectional;
            const DigitsVector way = endless ? -DigitsVector(source.direction)
                                             : DigitsVector(source.location) - meeting->point;
            if (source.casts_shadow && blocked(*meeting, {meeting->point, way}, endless)) continue;
            sample.lit |= std::uint64_t{1} << i;
            color += *added;
        }
        sample.hit = true;
        sample.object = meeting->object;
        sample.triangle = meeting->triangle;
    }
    sample.color = {channel(color.x), channel(color.y), channel(color.z)};
    return sample;
}

}  // namespace nuvo::hard
