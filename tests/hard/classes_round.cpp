#include "classes.h"

namespace nuvo::hard {
namespace {

Scene spheres(Random& random) {
    Scene scene;
    for (int i = 0; i < 30; ++i)
        add(scene, Sphere{random.point(6), random.snap(random.uniform(0.25, 2))});
    return scene;
}

// At (1 +- 1e-8 .. 1e-3) R; with all digits down to 1e-16.
Ray graze(const Scene&, Aims& aims, Random& random) {
    const double least = random.coordinates() == Coordinates::kDouble ? -16 : -8;
    const double offset = random.signed_power_of_ten(least, -3);
    const Object& object = aims.object();
    return aims.grazing(object, aims.outside(), offset);
}

// Radii of 5/8 k: lines along an axis, or along (4, -3, 0), are tangent exactly.
Scene tangent_spheres(Random& random) {
    Scene scene;
    for (int i = 0; i < 20; ++i) {
        const Point3 center{random.below(97) / 8.0 - 6, random.below(97) / 8.0 - 6,
                            random.below(97) / 8.0 - 6};
        add(scene, Sphere{center, 0.625 * (1 + random.below(3))});
    }
    return scene;
}

Ray exactly_tangent(const Scene&, Aims& aims, Random& random) {
    const Object& object = aims.object();
    const Sphere& sphere = std::get<Sphere>(object.shape);
    const int axis = random.below(3);
    const double sign = random.sign();
    Ray ray{sphere.center, {}};
    if (random.chance()) {
        ray.origin[axis] += sign * sphere.radius;
        const double sense = random.sign();
        ray.direction[(axis + 1) % 3] = sense * (1 + random.below(3));
    } else {
        ray.origin[axis] += sign * 3 * (sphere.radius / 5);
        ray.origin[(axis + 1) % 3] += sign * 4 * (sphere.radius / 5);
        ray.direction[axis] = 4;
        ray.direction[(axis + 1) % 3] = -3;
    }
    ray.origin = ray.origin - ray.direction * (random.below(9) - 2.0);
    return ray;
}

// Radius 1e-3 and less at 1e5.
Scene tiny_and_far(Random& random) {
    Scene scene;
    for (int i = 0; i < 30; ++i) {
        const Vector3 way = random.unit();
        const Point3 center = random.keep(way * random.power_of_ten(4, 6));
        const double size = random.keep(random.power_of_ten(-4, -1));
        switch (random.below(3)) {
            case 0:
                add(scene, Sphere{center, size});
                break;
            case 1:
                add(scene, Ellipsoid{center, distortion(random), size});
                break;
            default:
                add(scene, placed(closed_mesh(random, 0, 0.2), random, scaling({size, size, size}),
                                  center));
        }
    }
    return scene;
}

Ray from_near_the_origin(const Scene&, Aims& aims, Random& random) {
    const Object& object = aims.object();
    const Point3 from = random.point(10);
    if (random.chance() && !std::holds_alternative<TriangleMesh>(object.shape))
        return aims.grazing(object, from, random.signed_power_of_ten(-8, -1));
    return aims.from_to(from, aims.feature(object));
}

// Radius 1e3 to 1e9, the surface near the origin; small things on it.
Scene huge_and_near(Random& random) {
    Scene scene;
    const double radius = random.keep(random.power_of_ten(3, 9));
    add(scene, Sphere{{0, -radius, 0}, radius});
    add(scene, Ellipsoid{{0, -radius, 0}, scaling({1, 1, -2}), radius});
    for (int i = 0; i < 20; ++i) {
        Point3 center = random.point(8);
        center.y = random.power_of_ten(-3, 0);
        center = random.keep(center);
        if (random.chance())
            add(scene, Sphere{center, random.keep(random.power_of_ten(-3, 0))});
        else
            add(scene, placed(closed_mesh(random, 0, 0.2), random, Matrix3{}, center));
    }
    return scene;
}

Ray over_the_horizon(const Scene& scene, Aims& aims, Random& random) {
    Point3 eye = random.point(10);
    eye.y = random.keep(random.power_of_ten(-3, 1));
    switch (random.below(4)) {
        case 0:
            return aims.from_to(eye, aims.feature());
        case 1:
            return aims.grazing(scene.objects[0], eye, random.signed_power_of_ten(-14, -3));
        case 2:
            return aims.from_to(eye, eye + random.unit() + Vector3{0, -0.5, 0});
        default:
            return aims.from_to(aims.outside(), eye);
    }
}

Scene planet_and_ants(Random& random) {
    Scene scene;
    const double radius = 6.4e6;
    add(scene, Sphere{{0, -radius, 0}, radius});
    for (int i = 0; i < 25; ++i) {
        const Point3 on_ground{random.coordinate(0.25), 0, random.coordinate(0.25)};
        const double size = 0x1p-10;
        if (random.chance())
            add(scene, Sphere{random.keep(on_ground + Vector3{0, size, 0}), size});
        else
            add(scene, placed(closed_mesh(random, 0, 0.2), random, scaling({size, size, size}),
                              random.keep(on_ground + Vector3{0, 2 * size, 0})));
    }
    return scene;
}

Ray at_ants(const Scene& scene, Aims& aims, Random& random) {
    const Object& ant = scene.objects[static_cast<std::size_t>(
        1 + random.below(static_cast<int>(scene.objects.size()) - 1))];
    Point3 eye = random.point(random.chance() ? 0.5 : 100);
    eye.y = random.keep(random.power_of_ten(-3, 2));
    if (random.below(4) == 0) eye = aims.feature(ant);
    return aims.from_to(eye, random.below(4) == 0 ? Point3{eye.z, 0, eye.x} : aims.feature(ant));
}

Scene ellipsoids(Random& random) {
    Scene scene;
    for (int i = 0; i < 30; ++i)
        add(scene,
            Ellipsoid{random.point(6), distortion(random), random.snap(random.uniform(0.25, 2))});
    return scene;
}

Ray at_ellipsoids(const Scene& scene, Aims& aims, Random& random) {
    if (random.chance()) return graze(scene, aims, random);
    return aims.at_feature(random.below(4) == 0 ? aims.feature() : aims.outside());
}

}  // namespace

std::span<const HardClass> round_classes() {
    static constexpr HardClass kClasses[] = {
        {"grazing-spheres", spheres, graze, true},
        {"tangent-spheres", tangent_spheres, exactly_tangent, false},
        {"tiny-and-far", tiny_and_far, from_near_the_origin, true},
        {"huge-and-near", huge_and_near, over_the_horizon, false},
        {"planet-and-ants", planet_and_ants, at_ants, false},
        {"transforms", ellipsoids, at_ellipsoids, true},
    };
    return kClasses;
}

}  // namespace nuvo::hard
