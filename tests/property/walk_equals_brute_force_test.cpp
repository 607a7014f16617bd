#include <gtest/gtest.h>

#include "nuvo/render/render.h"
#include "test_scenes.h"

namespace nuvo {
namespace {

using testing::uniform;
using testing::uniform_point;

// Rays by the classes of thesis 5.5 and worse: the tree's own faces, edges and corners.
std::vector<Ray> hard_rays(const Scene& scene, const Octree& octree, unsigned seed, int count) {
    std::mt19937_64 random(seed);
    std::vector<Ray> rays;
    const auto node_corner = [&] {
        const Bounds3& box = octree.nodes()[random() % octree.nodes().size()].voxel.bounds;
        Point3 corner;
        for (int axis = 0; axis < 3; ++axis)
            corner[axis] = random() % 2 == 0 ? box.min[axis] : box.max[axis];
        return corner;
    };
    const auto sign = [&] { return random() % 2 == 0 ? 1.0 : -1.0; };
    const double zeros[2] = {0.0, -0.0};
    for (int i = 0; i < count; ++i) {
        const Point3 from = uniform_point(random, i % 2 == 0 ? 10 : 100);
        switch (i % 8) {
            case 0:
                rays.push_back({from, uniform_point(random, 10) - from});
                break;
            case 1: {  // along an edge of a voxel, both other components zero, of either sign
                Ray ray{node_corner(),
                        {zeros[random() % 2], zeros[random() % 2], zeros[random() % 2]}};
                const int axis = static_cast<int>(random() % 3);
                ray.direction[axis] = sign();
                ray.origin[axis] = -50 * ray.direction[axis];
                rays.push_back(ray);
                break;
            }
            case 2:
                rays.push_back({from, node_corner() - from});
                break;  // through a corner
            case 3: {   // an exact diagonal through a corner of a voxel
                const Vector3 d{sign(), sign(), sign()};
                rays.push_back({node_corner() - d * 64.0, d});
                break;
            }
            case 4: {  // within a face
                Ray ray{node_corner(), uniform_point(random, 1)};
                ray.direction[static_cast<int>(random() % 3)] = zeros[random() % 2];
                rays.push_back(ray);
                break;
            }
            case 5: {  // at a corner of a primitive
                const Object& object = scene.objects[random() % scene.objects.size()];
                Point3 target = bounds(object.shape).max;
                if (const auto* mesh = std::get_if<TriangleMesh>(&object.shape))
                    target = mesh->positions[random() % mesh->positions.size()];
                rays.push_back({from, target - from});
                break;
            }
            case 6:
                rays.push_back({from * 1e6, uniform_point(random, 10) - from * 1e6});
                break;
            default: {  // from a corner of a voxel, along few or many axes
                const Vector3 d{static_cast<double>(random() % 3) - 1,
                                static_cast<double>(random() % 3) - 1,
                                static_cast<double>(random() % 3) - 1};
                rays.push_back({node_corner(), d == Vector3{} ? Vector3{1, 0, 0} : d});
            }
        }
    }
    return rays;
}

void expect_walks_equal_brute_force(const Scene& scene, unsigned seed, int count) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    for (const LeafContent leaves : {LeafContent::kPrimitives, LeafContent::kShapes}) {
        for (const auto max_objects :
             {std::optional<std::size_t>(), std::optional<std::size_t>(2)}) {
            const Primitives primitives = flatten(scene, leaves);
            for (const MidpointChoice midpoint :
                 {MidpointChoice::kSpatial, MidpointChoice::kSweep, MidpointChoice::kPublished}) {
                Profile profile = exact_profile();
                profile.type = OctreeType::kNonuniform;  // cut at the spatial centre it is uniform
                profile.midpoint = midpoint;
                profile.leaves = leaves;
                profile.max_objects = max_objects;  // 2: as deep as trees get
                const Octree octree = build_tree(scene, primitives, profile);
                EXPECT_GT(octree.leaf_count(), 8U);
                const std::vector<Ray> rays = hard_rays(scene, octree, seed, count);
                const auto expected = closest_hits(scene, primitives, nullptr, profile, rays);
                for (const WalkChoice walk : {WalkChoice::kHash, WalkChoice::kDescent}) {
                    profile.walk = walk;
                    const auto found = closest_hits(scene, primitives, &octree, profile, rays);
                    int hits = 0;
                    for (std::size_t i = 0; i < rays.size(); ++i) {
                        hits += expected[i].hit;
                        ASSERT_TRUE(found[i].hit == expected[i].hit &&
                                    found[i].shape == expected[i].shape &&
                                    found[i].triangle == expected[i].triangle &&
                                    found[i].t == expected[i].t)
                            << "ray " << i << ": shape " << found[i].shape << " at " << found[i].t
                            << " instead of " << expected[i].shape << " at " << expected[i].t;
                    }
                    EXPECT_GT(hits, count / 10);
                }
            }
        }
    }
}

TEST(ExactWalk, EqualsBruteForceOnAGridWhereEverythingCoincides) {
    expect_walks_equal_brute_force(testing::grid_scene(), 101, 4000);
}

TEST(ExactWalk, EqualsBruteForceOnRandomScenes) {
    for (const unsigned seed : {1U, 2U, 3U})
        expect_walks_equal_brute_force(testing::random_scene(seed, 300), seed, 2000);
}

TEST(ExactWalk, PicturesAreTheSameForEveryTreeAndWalk) {
    for (const Scene& scene : {testing::grid_scene(), testing::random_scene(5, 300)}) {
        Profile profile = exact_profile();
        const Resolution resolution{96, 54};
        const Primitives primitives = flatten(scene, profile.leaves);
        const Image expected = render_brute_force(scene, primitives, profile, resolution);
        for (const OctreeType type : {OctreeType::kUniform, OctreeType::kNonuniform}) {
            profile.type = type;
            const Octree octree = build_tree(scene, primitives, profile);
            for (const WalkChoice walk : {WalkChoice::kHash, WalkChoice::kDescent}) {
                profile.walk = walk;
                EXPECT_EQ(render(scene, primitives, octree, profile, resolution), expected);
            }
        }
    }
}

}  // namespace
}  // namespace nuvo
