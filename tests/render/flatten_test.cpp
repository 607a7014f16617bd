// The scene flattened for tracing, on any number of threads.
#include <gtest/gtest.h>

#include <random>

#include "nuvo/render/primitives.h"

namespace nuvo {
namespace {

/// A mesh of random triangles over few points, so that some have corners in common or on one line.
TriangleMesh random_mesh(std::mt19937& random, std::size_t triangles) {
    TriangleMesh mesh;
    std::uniform_int_distribution<int> coordinate(-3, 3);
    for (int i = 0; i < 40; ++i)
        mesh.positions.push_back({static_cast<double>(coordinate(random)),
                                  static_cast<double>(coordinate(random)), 0.5 * i});
    std::uniform_int_distribution<std::uint32_t> corner(0, 39);
    for (std::size_t i = 0; i < triangles; ++i)
        mesh.triangles.push_back({corner(random), corner(random), corner(random)});
    return mesh;
}

Scene random_scene(unsigned seed) {
    std::mt19937 random(seed);
    Scene scene;
    for (const std::size_t triangles : {3, 9000, 1, 20'000, 4096, 4097}) {
        scene.objects.push_back({random_mesh(random, triangles), 0, 0});
        scene.objects.push_back({Sphere{{1, 2, static_cast<double>(triangles)}, 2}, 0, 0});
    }
    return scene;
}

TEST(Flatten, ListsTrianglesWithAnAreaAndQuadricsInDocumentOrder) {
    constexpr unsigned kSeed = 5;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    const Scene scene = random_scene(kSeed);
    for (const int threads : {1, 2, 7}) {
        const Primitives all = flatten(scene, LeafContent::kPrimitives, threads);
        const Primitives whole = flatten(scene, LeafContent::kShapes, threads);
        std::size_t place = 0, item = 0, flat = 0;
        std::array<Bounds3, 3> boxes;
        const auto expect_next = [&](std::uint32_t object, std::uint32_t triangle,
                                     const Bounds3& box) {
            ASSERT_LT(place, all.sources.size());
            for (const Primitives* list : {&all, &whole}) {
                EXPECT_EQ(list->sources[place].object, object);
                EXPECT_EQ(list->sources[place].triangle, triangle);
            }
            EXPECT_EQ(all.item_first[place], place);
            EXPECT_EQ(all.item_boxes[place].min, box.min);
            EXPECT_EQ(all.item_boxes[place].max, box.max);
            Bounds3& around = boxes[static_cast<std::size_t>(kind_of(scene.objects[object].shape))];
            around = around.extended(box);
            ++place;
        };
        for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
            const Shape& shape = scene.objects[object].shape;
            const std::size_t before = place;
            if (const auto* mesh = std::get_if<TriangleMesh>(&shape)) {
                for (std::uint32_t i = 0; i < mesh->triangles.size(); ++i) {
                    const Triangle t = mesh->triangle(i);
                    // Small whole numbers and halves: exact.
                    if (cross(t.b - t.a, t.c - t.a) == Vector3{})
                        ++flat;
                    else
                        expect_next(object, i, t.bounds());
                }
            } else {
                expect_next(object, 0, bounds(shape));
            }
            if (place == before) continue;
            ASSERT_LT(item, whole.item_count());
            EXPECT_EQ(whole.of_item(item).first, before);
            EXPECT_EQ(whole.of_item(item).last, place);
            ++item;
        }
        EXPECT_GT(flat, 100u);
        EXPECT_EQ(all.zero_area_triangles, flat);
        EXPECT_EQ(all.sources.size(), place);
        EXPECT_EQ(all.item_first.size(), place + 1);
        EXPECT_EQ(whole.item_count(), item);
        for (std::size_t kind = 0; kind < boxes.size(); ++kind) {
            EXPECT_EQ(all.kinds[kind].box.min, boxes[kind].min);
            EXPECT_EQ(all.kinds[kind].box.max, boxes[kind].max);
        }
        EXPECT_FALSE(all.sorted_by_kind);
    }
}

}  // namespace
}  // namespace nuvo
