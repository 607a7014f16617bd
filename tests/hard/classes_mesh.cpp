#include "classes.h"

namespace nuvo::hard {
namespace {

Scene some_mix(Random& random) { return mixed_scene(random, 40); }

Scene lattice_or_mix(Random& random) {
    return random.chance() ? lattice_scene(random) : mixed_scene(random, 40);
}

Ray axis_parallel(const Scene&, Aims& aims, Random& random) {
    return aims.parallel_to_axis(random.below(4) == 0 ? aims.outside() : aims.feature());
}

Ray in_split_planes(const Scene&, Aims& aims, Random&) { return aims.in_split_plane(); }

// Almost parallel: components of 1e-8 to 1e-320 where others are 1.
Ray almost_parallel(const Scene&, Aims& aims, Random& random) {
    Ray ray = aims.parallel_to_axis(random.below(4) == 0 ? aims.outside() : aims.feature());
    for (int axis = 0; axis < 3; ++axis) {
        const double least = random.coordinates() == Coordinates::kDouble ? -320 : -37;
        if (ray.direction[axis] == 0 && random.below(3) != 0)
            ray.direction[axis] = random.keep(random.signed_power_of_ten(least, -8));
    }
    return ray;
}

// A scene without thickness: everything lies in one plane of coordinates.
Scene flat(Random& random) {
    Scene scene;
    const int axis = random.below(3);
    const double height = random.chance() ? 0 : random.coordinate(8);
    const auto corner = [&] {
        Point3 p = random.point(8);
        p[axis] = height;
        return p;
    };
    for (int i = 0; i < 40; ++i) {
        const Point3 a = corner();
        const Point3 b = corner();
        add(scene, single(a, b, corner()));
    }
    return scene;
}

// Plates and boxes on even coordinates around 0, where the spatial midpoints fall.
Scene plates(Random& random) {
    Scene scene;
    for (const double x : {-4.0, 4.0})  // the root's box, symmetrical
        for (const double y : {-4.0, 4.0})
            for (const double z : {-4.0, 4.0}) add(scene, Sphere{{x, y, z}, 0.5});
    for (int i = 0; i < 24; ++i) {
        const int axis = random.below(3);
        Point3 corner;
        for (int k = 0; k < 3; ++k) corner[k] = random.below(9) - 4.0;
        Point3 b = corner;
        Point3 c = corner;
        b[(axis + 1) % 3] += 1 + random.below(3);
        c[(axis + 2) % 3] += random.sign();
        const double height = 2.0 * (random.below(5) - 2);
        corner[axis] = b[axis] = c[axis] = random.chance() ? height : 0;
        add(scene, single(corner, b, c));
    }
    return scene;
}

Ray at_plates(const Scene&, Aims& aims, Random& random) {
    if (random.below(3) == 0) return aims.in_split_plane();
    return aims.at_feature(random.chance() ? aims.outside() : aims.feature());
}

Scene one_closed_mesh(Random& random) {
    Scene scene;
    add(scene, closed_mesh(random, 1 + random.below(2), 0.25));
    return scene;
}

Ray from_outside(const Scene&, Aims& aims, Random&) { return aims.at_feature(aims.outside()); }

Ray from_inside(const Scene&, Aims& aims, Random& random) {
    const Object& object = aims.object();
    const Vector3 way = random.unit();
    Point3 from = aims.middle(object) + way * (aims.half_size(object) * random.uniform(0, 0.3));
    if (random.below(4) == 0) from = aims.middle(object);
    return aims.from_to(from, aims.feature(object));
}

Scene stretched(Random& random) {
    Scene scene;
    Matrix3 linear = scaling({std::exp2(random.below(20) - 10), 1, std::exp2(random.below(16))});
    if (random.coordinates() == Coordinates::kDouble) linear = rotation(random.unit(), 1) * linear;
    add(scene, placed(closed_mesh(random, 1 + random.below(2), 0.25), random, linear, {}));
    return scene;
}

Ray from_in_or_out(const Scene& scene, Aims& aims, Random& random) {
    return random.chance() ? from_inside(scene, aims, random) : from_outside(scene, aims, random);
}

// Thin triangles, some without area, some in fans with neighbours that are not thin.
Scene slivers(Random& random) {
    Scene scene;
    for (int i = 0; i < 60; ++i) {
        const Point3 a = random.point(4);
        const Point3 b = random.point(4);
        const double thickness = std::exp2(-random.below(40));
        const double part = random.uniform(0, 1);
        Point3 c = random.keep(a + (b - a) * part + random.unit() * thickness);
        if (i % 8 == 0) c = random.chance() ? b : random.keep(a + (b - a) * 2.0);
        if (i % 8 == 1) {
            const Point3 peak = random.point(4);
            TriangleMesh fan = single(a, b, c);
            fan.positions.push_back(peak);
            fan.triangles.insert(fan.triangles.end(), {{0, 2, 3}, {2, 1, 3}, {1, 0, 3}});
            add(scene, fan);
        } else {
            add(scene, single(a, b, c));
        }
    }
    return scene;
}

// The same faces twice, reversed, in parts, and round surfaces that touch them.
Scene coincident(Random& random) {
    Scene scene;
    const TriangleMesh mesh = closed_mesh(random, 1, 0.2);
    add(scene, mesh);
    TriangleMesh turned = mesh;
    for (IndexTriple& t : turned.triangles) std::swap(t[0], t[random.below(3)]);
    add(scene, turned);
    const Point3 low{-1, -1, -1};
    add(scene, box_mesh(low, {1, 1, 1}));
    add(scene, box_mesh(low, {1, 1, 1}));
    add(scene, box_mesh({-0.5, -1, -0.5}, {0.5, 2, 0.5}));  // faces within faces
    add(scene, Sphere{{0, 0, 0}, 1});                       // touches the boxes
    add(scene, Ellipsoid{{0, 0, 0}, scaling({1, -1, 1}), 1});
    add(scene, Sphere{{0, 0, 0}, 1});
    const Triangle face = mesh.triangle(0);
    add(scene, single(face.a, face.b, random.keep(face.b * 0.5 + face.c * 0.5)));
    return scene;
}

// Gaps of 0.1 to 1e-8 between neighbours along x.
Scene contact_gaps(Random& random) {
    Scene scene;
    double x = -4;
    for (int i = 0; i < 12; ++i) {
        const double gap = random.power_of_ten(-8, -1);
        if (random.chance()) {
            add(scene,
                box_mesh(random.keep(Point3{x + gap, -1, -1}), random.keep(Point3{x + 0.5, 1, 1})));
        } else {
            add(scene, Sphere{random.keep(Point3{x + gap + 0.25, random.coordinate(1), 0}), 0.25});
        }
        x += 0.5;
    }
    return scene;
}

Ray along_gaps(const Scene& scene, Aims& aims, Random& random) {
    if (random.below(3) == 0) return axis_parallel(scene, aims, random);
    return aims.at_feature(random.chance() ? aims.outside() : aims.feature());
}

// Every object has a corner, its centre or its surface at one point.
Scene at_one_point(Random& random) {
    Scene scene;
    const Point3 p = random.chance() ? Point3{} : random.point(4);
    for (int i = 0; i < 24; ++i) {
        const double size = random.snap(random.uniform(0.5, 3));
        switch (random.below(4)) {
            case 0:
                add(scene, Sphere{p, size});
                break;
            case 1:
                add(scene, Sphere{random.keep(p + Vector3{size, 0, 0}), size});
                break;
            case 2:
                add(scene, placed(closed_mesh(random, 0, 0.2), random, Matrix3{}, p));
                break;
            default: {
                const Point3 b = random.keep(p + random.point(3));
                add(scene, single(p, b, random.keep(p + random.point(3))));
            }
        }
    }
    return scene;
}

Ray through_one_point(const Scene& scene, Aims& aims, Random& random) {
    Point3 p = aims.middle(scene.objects[0]);
    for (const Object& object : scene.objects)
        if (const auto* mesh = std::get_if<TriangleMesh>(&object.shape))
            if (mesh->triangles.size() == 1) p = mesh->positions[0];
    switch (random.below(3)) {
        case 0:
            return aims.from_to(p, aims.feature());
        case 1:
            return aims.parallel_to_axis(p);
        default:
            return aims.from_to(aims.outside(), p);
    }
}

// Many small objects across the plane z = 0, which is a split plane.
Scene across_one_plane(Random& random) {
    Scene scene;
    for (int i = 0; i < 400; ++i) {
        Point3 center = random.point(8);
        center.z = random.chance() ? 0 : random.coordinate(0.25);
        const double size = 0.25;
        if (random.below(4) == 0) {
            add(scene, Sphere{center, size});
        } else {
            add(scene, single(random.keep(center + Vector3{size, 0, -size}),
                              random.keep(center + Vector3{-size, size, 0}),
                              random.keep(center + random.point(1) + Vector3{0, 0, size})));
        }
    }
    return scene;
}

Ray in_one_plane(const Scene&, Aims& aims, Random& random) {
    Ray ray = aims.at_feature(aims.outside());
    if (random.chance()) {
        ray.origin.z = random.zero();
        ray.direction.z = random.zero();
    }
    return ray;
}

}  // namespace

std::span<const HardClass> mesh_classes() {
    static constexpr HardClass kClasses[] = {
        {"axis-parallel", lattice_or_mix, axis_parallel, true},
        {"almost-axis-parallel", lattice_or_mix, almost_parallel, true},
        {"flat-scene", flat, at_plates, false},
        {"split-planes", some_mix, in_split_planes, true},
        {"triangles-in-split-planes", plates, at_plates, false},
        {"closed-mesh-outside", one_closed_mesh, from_outside, false},
        {"closed-mesh-inside", one_closed_mesh, from_inside, false},
        {"stretched-mesh", stretched, from_in_or_out, false},
        {"slivers", slivers, from_outside, false},
        {"coincident-surfaces", coincident, from_in_or_out, false},
        {"contact-gaps", contact_gaps, along_gaps, false},
        {"one-point", at_one_point, through_one_point, false},
        {"one-plane", across_one_plane, in_one_plane, false},
    };
    return kClasses;
}

}  // namespace nuvo::hard
