#include "aims.h"

namespace nuvo::hard {

Aims::Aims(const Scene& scene, const Octree& octree, Random& random)
    : scene_(scene), octree_(octree), random_(random) {
    Bounds3 all;
    for (const Object& object : scene.objects) all = all.extended(bounds(object.shape));
    middle_ = all.center();
    half_ = max_norm(all.widths()) / 2;
}

Ray Aims::from_to(const Point3& from, const Point3& to) const {
    const Point3 origin = random_.keep(from);
    const Vector3 direction = random_.keep(to - origin);
    return {origin, direction == Vector3{} ? Vector3{1, 0, 0} : direction};
}

Point3 Aims::outside(double factor) {
    const double least = half_ * random_.uniform(2, 4);
    const double distance = least * random_.uniform(1, factor);
    if (random_.coordinates() != Coordinates::kLattice)
        return random_.keep(middle_ + random_.unit() * distance);
    // A small multiple of a power of two, so that differences stay exact.
    const double unit = std::exp2(std::floor(std::log2(distance))) / 16;
    const Vector3 steps = random_.unit() * 32;
    return random_.keep(
        middle_ +
        Vector3{std::nearbyint(steps.x), std::nearbyint(steps.y), std::nearbyint(steps.z)} * unit);
}

const Object& Aims::object() {
    return scene_
        .objects[static_cast<std::size_t>(random_.below(static_cast<int>(scene_.objects.size())))];
}

Point3 Aims::middle(const Object& object) { return bounds(object.shape).center(); }

double Aims::half_size(const Object& object) { return max_norm(bounds(object.shape).widths()) / 2; }

Point3 Aims::feature() { return feature(object()); }

Point3 Aims::feature(const Object& object) {
    const auto* mesh = std::get_if<TriangleMesh>(&object.shape);
    if (!mesh) return random_.below(4) == 0 ? middle(object) : on_surface(object);
    const Triangle t = mesh->triangle(
        static_cast<std::size_t>(random_.below(static_cast<int>(mesh->triangles.size()))));
    switch (random_.below(5)) {
        case 0:
            return t.a;
        case 1:
            return t.b * 0.5 + t.c * 0.5;
        case 2:
            return t.c * 0.25 + t.a * 0.75;
        case 3: {
            const double s = random_.uniform(0, 1);
            return t.a * (1 - s) + t.b * s;
        }
        default:
            return on_surface(object);
    }
}

Point3 Aims::on_surface(const Object& object) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&object.shape)) {
        const Triangle t = mesh->triangle(
            static_cast<std::size_t>(random_.below(static_cast<int>(mesh->triangles.size()))));
        const double v = random_.uniform(0, 1);
        const double w = random_.uniform(0, 1 - v);
        return t.a * (1 - v - w) + t.b * v + t.c * w;
    }
    Vector3 side = random_.unit();
    if (random_.chance()) {  // 1 + 16 + 64 = 81: exact where the radius is a multiple of 9
        side = Vector3{1, 4, 8} / 9;
        for (int axis = 0; axis < 3; ++axis) {
            std::swap(side[axis], side[random_.below(3)]);
            side[axis] *= random_.sign();
        }
    } else if (random_.chance()) {
        side = {};
        side[random_.below(3)] = random_.sign();
    }
    if (const auto* sphere = std::get_if<Sphere>(&object.shape))
        return sphere->center + side * sphere->radius;
    const auto& ellipsoid = std::get<Ellipsoid>(object.shape);
    return ellipsoid.center + ellipsoid.linear * (side * ellipsoid.radius);
}

Ray Aims::grazing(const Object& object, const Point3& from, double offset) {
    const auto* ellipsoid = std::get_if<Ellipsoid>(&object.shape);
    const Point3 center = middle(object);
    Vector3 axis = from - center;
    double radius = half_size(object);
    if (ellipsoid) {
        const Matrix3 adjugate = ellipsoid->linear.adjugate();
        axis = adjugate * axis / ellipsoid->linear.determinant();
        radius = ellipsoid->radius;
    }
    // The points that see the centre at distance h from their line lie on a cone around `axis`.
    const double h = radius * (1 + offset);
    const double cosine = h / length(axis);
    if (!(cosine < 1)) return from_to(from, center);
    const Vector3 across = normalized(cross(axis, random_.unit()));
    const Vector3 touch =
        normalized(axis) * (h * cosine) + across * (h * std::sqrt(1 - cosine * cosine));
    return from_to(from, center + (ellipsoid ? ellipsoid->linear * touch : touch));
}

Ray Aims::parallel_to_axis(const Point3& p) {
    Ray ray{p, {random_.zero(), random_.zero(), random_.zero()}};
    const int axis = random_.below(3);
    const double sign = random_.sign();
    ray.direction[axis] = random_.chance() ? sign : sign * half_ * 3;
    ray.origin[axis] = random_.below(4) == 0 ? p[axis] : middle_[axis] - sign * 4 * half_;
    ray.origin = random_.keep(ray.origin);
    ray.direction = random_.keep(ray.direction);
    return ray;
}

Point3 Aims::voxel_corner() {
    const auto nodes = octree_.nodes();
    const Bounds3& box =
        nodes[static_cast<std::size_t>(random_.below(static_cast<int>(nodes.size())))].voxel.bounds;
    Point3 corner;
    for (int axis = 0; axis < 3; ++axis)
        corner[axis] = random_.chance() ? box.min[axis] : box.max[axis];
    return corner;
}

// The tree's planes are where they are: these rays keep all digits.
Ray Aims::in_split_plane() {
    const Point3 corner = voxel_corner();
    const Vector3 d{random_.sign(), random_.sign(), random_.sign()};
    switch (random_.below(6)) {
        case 0: {  // along an edge
            Ray ray{corner, {random_.zero(), random_.zero(), random_.zero()}};
            const int axis = random_.below(3);
            ray.direction[axis] = d[axis];
            ray.origin[axis] = middle_[axis] - 4 * half_ * d[axis];
            return ray;
        }
        case 1: {  // corner to corner
            const Vector3 way = voxel_corner() - corner;
            return {corner, way == Vector3{} ? d : way};
        }
        case 2:  // an exact diagonal
            return {corner - d * (4 * std::exp2(std::ceil(std::log2(half_)))), d};
        case 3: {  // within a face
            Ray ray{corner, random_.unit()};
            ray.direction[random_.below(3)] = random_.zero();
            ray.origin = ray.origin - ray.direction * (random_.below(2) * half_);
            return ray;
        }
        case 4: {  // through a corner
            const Point3 from = outside();
            return {from, corner - from};
        }
        default: {  // within a face, at an object
            Ray ray = {outside(), {}};
            const int axis = random_.below(3);
            const Point3 target = feature();
            ray.origin[axis] = corner[axis];
            ray.direction = target - ray.origin;
            ray.direction[axis] = random_.zero();
            return ray;
        }
    }
}

}  // namespace nuvo::hard
