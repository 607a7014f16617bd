#include "parts.h"

#include <algorithm>
#include <map>
#include <utility>

namespace nuvo::hard {
namespace {

TriangleMesh octahedron() {
    TriangleMesh mesh;
    mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                      {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    return mesh;
}

// Every face cut in four at the middles of its edges, which neighbours share.
TriangleMesh refined(const TriangleMesh& mesh) {
    TriangleMesh out;
    out.positions = mesh.positions;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [place, fresh] =
            middles.try_emplace(std::pair(std::min(a, b), std::max(a, b)),
                                static_cast<std::uint32_t>(out.positions.size()));
        if (fresh)
            out.positions.push_back(normalized(mesh.positions[a] * 0.5 + mesh.positions[b] * 0.5));
        return place->second;
    };
    for (const IndexTriple& t : mesh.triangles) {
        const std::uint32_t ab = middle(t[0], t[1]);
        const std::uint32_t bc = middle(t[1], t[2]);
        const std::uint32_t ca = middle(t[2], t[0]);
        out.triangles.insert(out.triangles.end(),
                             {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
    }
    return out;
}

}  // namespace

TriangleMesh closed_mesh(Random& random, int level, double roughness) {
    TriangleMesh mesh = octahedron();
    for (int i = 0; i < level; ++i) mesh = refined(mesh);
    for (Point3& p : mesh.positions)
        p = random.snap(p * (1 + random.uniform(-roughness, roughness)));
    return mesh;
}

TriangleMesh box_mesh(const Point3& low, const Point3& high) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.push_back(
            {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

TriangleMesh single(const Point3& a, const Point3& b, const Point3& c) {
    TriangleMesh mesh;
    mesh.positions = {a, b, c};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

TriangleMesh placed(TriangleMesh mesh, const Random& random, const Matrix3& linear,
                    const Vector3& move) {
    for (Point3& p : mesh.positions) p = random.keep(linear * p + move);
    return mesh;
}

Matrix3 scaling(const Vector3& factors) {
    return {{{factors.x, 0, 0}, {0, factors.y, 0}, {0, 0, factors.z}}};
}

Matrix3 distortion(Random& random) {
    Matrix3 m;
    switch (random.below(4)) {
        case 0:
            m = scaling({random.power_of_ten(-1, 0.5), random.power_of_ten(-1, 0.5),
                         -random.power_of_ten(-1, 0.5)});
            break;
        case 1:
            m.row[0].y = random.coordinate(2);
            m.row[1].z = random.coordinate(2);
            break;
        case 2: {
            const Vector3 axis = random.unit();
            const Matrix3 turn = rotation(axis, random.uniform(0, 3));
            m = turn * scaling({1, random.power_of_ten(-6, 0), 1});
            break;
        }
        default:
            m = {{random.unit(), random.unit(), random.unit()}};
    }
    for (Vector3& row : m.row) row = random.keep(row);
    return m.determinant() == 0 ? Matrix3{} : m;
}

void add(Scene& scene, Shape shape) {
    Object object;
    object.shape = std::move(shape);
    object.solid = false;
    object.shape_index = static_cast<std::uint32_t>(scene.objects.size());
    scene.objects.push_back(std::move(object));
    scene.materials = {Material{}};
    scene.shape_count = scene.objects.size();
}

void place(Scene& scene, const Random& random, double scale, const Vector3& move) {
    const auto held = [&](const Point3& p) { return random.keep(p * scale + move); };
    for (Object& object : scene.objects) {
        if (auto* mesh = std::get_if<TriangleMesh>(&object.shape)) {
            for (Point3& p : mesh->positions) p = held(p);
        } else if (auto* sphere = std::get_if<Sphere>(&object.shape)) {
            *sphere = {held(sphere->center), random.keep(sphere->radius * scale)};
        } else {
            auto& ellipsoid = std::get<Ellipsoid>(object.shape);
            ellipsoid.center = held(ellipsoid.center);
            ellipsoid.radius = random.keep(ellipsoid.radius * scale);
        }
    }
}

Scene mixed_scene(Random& random, int count) {
    Scene scene;
    for (int i = 0; i < count; ++i) {
        const Point3 center = random.point(8);
        const double size = random.snap(random.uniform(0.25, 1.5));
        switch (random.below(5)) {
            case 0:
                add(scene, Sphere{center, size});
                break;
            case 1:
                add(scene, Ellipsoid{center, distortion(random), size});
                break;
            case 2:
                add(scene, placed(closed_mesh(random, random.below(2), 0.2), random,
                                  scaling({size, size, size}), center));
                break;
            case 3:
                add(scene, box_mesh(center, random.keep(center + Vector3{size, 2 * size, size})));
                break;
            default: {
                const Point3 b = random.keep(center + random.point(3));
                add(scene, single(center, b, random.keep(center + random.point(3))));
            }
        }
    }
    return scene;
}

Scene lattice_scene(Random& random) {
    Scene scene;
    const TriangleMesh unit = octahedron();
    for (int x = -2; x <= 2; x += 2)
        for (int y = -2; y <= 2; y += 2)
            for (int z = -2; z <= 2; z += 2) {
                const Vector3 center{x * 1.0, y * 1.0, z * 1.0};
                if (random.below(3) == 0)
                    add(scene, Sphere{center, 1});
                else
                    add(scene, placed(unit, random, Matrix3{}, center));
            }
    return scene;
}

}  // namespace nuvo::hard
