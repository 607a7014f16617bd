#include "leaks.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <ostream>
#include <vector>

#include "nuvo/math/parallel.h"
#include "nuvo/render/render.h"
#include "parts.h"
#include "threads.h"

namespace nuvo::hard {
namespace {

constexpr std::uint64_t kRaysPerMesh = 20'000;

// closed_mesh() is seen whole from within 0.5 of its middle, and so is its image under a linear
// map from the image of that ball; rounding of the corners moves them by far less than the rest.
struct ClosedScene {
    Scene scene;
    Matrix3 linear;
    Vector3 move;
};

ClosedScene closed_scene(Random& random) {
    ClosedScene closed;
    switch (random.below(4)) {
        case 0:
            break;
        case 1:
            closed.linear = scaling({std::exp2(random.below(12)), 1, std::exp2(-random.below(8))});
            break;
        case 2: {
            const Matrix3 turn = rotation(random.unit(), 1);
            closed.linear = turn * scaling({1, random.uniform(0.01, 1), -1});
            break;
        }
        default: {
            const double scale = std::pow(10, random.below(31) - 15);
            closed.linear = scaling({scale, scale, scale});
        }
    }
    if (random.below(4) == 0 && max_norm(closed.linear.row[0]) > 0.1) closed.move = {1e5, -1e5, 64};
    add(closed.scene,
        placed(closed_mesh(random, 1 + random.below(3), 0.25), random, closed.linear, closed.move));
    return closed;
}

Point3 target(const TriangleMesh& mesh, Random& random) {
    const Triangle t = mesh.triangle(
        static_cast<std::size_t>(random.below(static_cast<int>(mesh.triangles.size()))));
    switch (random.below(4)) {
        case 0:
            return t.a;
        case 1:
            return t.a * 0.5 + t.b * 0.5;
        case 2: {
            const double s = random.below(65) / 64.0;
            return t.b * (1 - s) + t.c * s;
        }
        default: {
            const double s = random.uniform(0, 1);
            return t.c * (1 - s) + t.a * s;
        }
    }
}

std::uint64_t leaks_of_batch(std::uint64_t number, std::uint64_t rays_wanted, std::uint64_t seed,
                             std::ostream& faults, std::mutex& mutex) {
    Random random(mixed_seed(seed, 1000, number), static_cast<Coordinates>(number % 3));
    const ClosedScene closed = closed_scene(random);
    const auto& mesh = std::get<TriangleMesh>(closed.scene.objects[0].shape);
    Profile profile = exact_profile();
    profile.type = random.chance() ? OctreeType::kUniform : OctreeType::kNonuniform;
    profile.midpoint = random.chance() ? MidpointChoice::kPublished : MidpointChoice::kSweep;
    profile.walk = random.chance() ? WalkChoice::kHash : WalkChoice::kDescent;
    const Primitives primitives = flatten(closed.scene, profile.leaves);
    const Octree octree = build_tree(closed.scene, primitives, profile);
    std::vector<Ray> rays;
    for (std::uint64_t i = 0; i < rays_wanted; ++i) {
        const Vector3 way = random.unit();
        const Point3 inside = way * (random.below(4) * 0.125);
        const Point3 from = random.keep(closed.linear * inside + closed.move);
        rays.push_back({from, random.keep(target(mesh, random) - from)});
    }
    const auto answers = closest_hits(closed.scene, primitives, &octree, profile, rays);
    std::uint64_t leaks = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (answers[i].hit) continue;
        ++leaks;
        const std::lock_guard lock(mutex);
        faults << "leak: batch " << number << " ray " << i << " seed " << seed << "\n";
    }
    return leaks;
}

}  // namespace

LeakCount count_leaks(std::uint64_t rays, std::uint64_t seed, unsigned threads,
                      std::ostream& faults) {
    const std::uint64_t batches = (rays + kRaysPerMesh - 1) / kRaysPerMesh;
    std::atomic<std::uint64_t> leaks{0};
    std::mutex mutex;
    for_each_index(thread_count(threads), batches, [&](std::size_t i, int) {
        leaks +=
            leaks_of_batch(i, std::min(kRaysPerMesh, rays - i * kRaysPerMesh), seed, faults, mutex);
    });
    return {rays, leaks};
}

}  // namespace nuvo::hard
