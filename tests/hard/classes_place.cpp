#include "classes.h"

namespace nuvo::hard {
namespace {

Scene mix(Random& random) { return mixed_scene(random, 40); }

Scene moved(Random& random) {
    Scene scene = random.chance() ? lattice_scene(random) : mixed_scene(random, 30);
    const Vector3 way{1e6 * random.sign(), 1e6, -1e6};
    place(scene, random, 1, way * (random.chance() ? 1 : 8));
    return scene;
}

// By 1e-15 .. 1e15, or by powers of two, which keep the lattice.
Scene scaled(Random& random) {
    Scene scene = random.chance() ? lattice_scene(random) : mixed_scene(random, 30);
    const double scale = random.coordinates() == Coordinates::kLattice
                             ? std::exp2(random.below(101) - 50)
                             : std::pow(10, random.below(31) - 15);
    place(scene, random, scale, {});
    return scene;
}

Ray everywhere(const Scene&, Aims& aims, Random& random) {
    switch (random.below(6)) {
        case 0:
            return aims.parallel_to_axis(aims.feature());
        case 1:
            return aims.in_split_plane();
        case 2:
            return aims.at_feature(aims.feature());
        case 3: {
            const Point3 from = aims.outside();
            return aims.from_to(from, aims.middle(aims.object()));
        }
        default:
            return aims.at_feature(aims.outside());
    }
}

// Radii are multiples of 9/64: points of their surfaces lie on the lattice.
Scene to_start_from(Random& random) {
    Scene scene;
    for (int i = 0; i < 40; ++i) {
        const Point3 center = random.point(8);
        const double size = random.snap(random.uniform(0.25, 2));
        switch (random.below(4)) {
            case 0:
                add(scene, Sphere{center, 9 * (1 + random.below(16)) / 64.0});
                break;
            case 1:
                add(scene, Ellipsoid{center, distortion(random), size});
                break;
            default:
                add(scene, placed(closed_mesh(random, random.below(2), 0.2), random,
                                  scaling({size, size, size}), center));
        }
    }
    return scene;
}

Ray starting_on_a_surface(const Scene&, Aims& aims, Random& random) {
    const Object& object = aims.object();
    const Point3 from = aims.feature(object);
    switch (random.below(5)) {
        case 0:
            return aims.from_to(from, aims.feature(object));  // also within its own plane
        case 1:
            return aims.from_to(from, aims.middle(object));
        case 2: {
            Ray ray = aims.parallel_to_axis(from);
            ray.origin = random.keep(from);
            return ray;
        }
        case 3:
            return aims.from_to(from, aims.outside());
        default:
            return aims.from_to(from, aims.feature());
    }
}

Ray starting_inside(const Scene&, Aims& aims, Random& random) {
    const Object& object = aims.object();
    const Vector3 way = random.unit();
    const Point3 from = aims.middle(object) + way * (aims.half_size(object) * random.uniform(0, 1));
    return aims.from_to(from, random.chance() ? aims.feature(object) : aims.feature());
}

// t is large or small: directions of any length.
Ray any_length(const Scene& scene, Aims& aims, Random& random) {
    Ray ray = everywhere(scene, aims, random);
    const int most = random.coordinates() == Coordinates::kDouble ? 300 : 60;
    const double factor = std::exp2(random.below(2 * most + 1) - most);
    ray.direction = random.keep(ray.direction * factor);
    return ray;
}

// From 1 to 1e33 scene widths away; through the middle, where a direction aims no better.
Ray from_afar(const Scene& scene, Aims& aims, Random& random) {
    const Point3 from = aims.outside(std::pow(10, random.below(34)));
    if (random.below(4) == 0) {
        const Object& object = scene.objects[0];
        if (!std::holds_alternative<TriangleMesh>(object.shape))
            return aims.grazing(object, from, random.signed_power_of_ten(-12, -1));
    }
    return aims.from_to(from, random.below(3) == 0 ? Point3{} : aims.feature());
}

}  // namespace

std::span<const HardClass> place_classes() {
    static constexpr HardClass kClasses[] = {
        {"moved-by-1e6", moved, everywhere, true},
        {"scaled", scaled, everywhere, true},
        {"origins-on-surfaces", to_start_from, starting_on_a_surface, true},
        {"origins-inside", to_start_from, starting_inside, true},
        {"distant-origins", mix, from_afar, true},
        {"directions-of-any-length", mix, any_length, true},
        {"everything", mix, everywhere, true},
    };
    return kClasses;
}

}  // namespace nuvo::hard
