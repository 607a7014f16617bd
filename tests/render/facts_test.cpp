#include <gtest/gtest.h>

#include "nuvo/render/render.h"

namespace nuvo {
namespace {

constexpr Resolution kThreeByThree{3, 3};
constexpr std::size_t kCenter = 4;

Light directional(const Vector3& direction) {
    Light light;
    light.direction = direction;
    return light;
}

Light lamp(const Point3& location) {
    Light light;
    light.kind = Light::Kind::kPoint;
    light.location = location;
    return light;
}

/// A unit sphere in the middle, met at (0, 0, 1) by the ray of the middle pixel only, and a smaller
/// one above that point, between the rays.
Scene two_spheres() {
    Scene scene;
    scene.materials = {Material{}};
    scene.objects = {{Sphere{{0, 1.9, 1}, 0.3}, 0, 0}, {Sphere{{0, 0, 0}, 1}, 0, 1}};
    scene.shape_count = 2;
    return scene;
}

std::vector<PixelFacts> facts(const Scene& scene, const Profile& profile) {
    const Primitives primitives = flatten(scene, profile.leaves);
    return render_facts(scene, primitives, build_tree(scene, primitives, profile), profile,
                        kThreeByThree);
}

TEST(PixelFacts, TellThePrimitiveAndTheLightsThatReachIt) {
    Scene scene = two_spheres();
    Light beyond = lamp({0, 0, 5});
    beyond.radius = 1;
    Light headlight = directional({0, 0, 1});
    headlight.casts_shadow = false;
    scene.lights = {directional({0, 0, -1}),  // from the camera's side: reaches
                    directional({0, 0, 1}),   // from behind: the sphere is in its own way
                    lamp({0, 0, 5}),          // before the sphere: reaches
                    lamp({0, 6, 1}),          // behind the smaller sphere
                    beyond,                   // ends before the sphere
                    headlight};               // reaches whatever stands between
    for (const Precision precision : {Precision::kFloat, Precision::kDouble, Precision::kExact}) {
        Profile profile = exact_profile();
        profile.precision = precision;
        const std::vector<PixelFacts> all = facts(scene, profile);
        ASSERT_EQ(all.size(), 9u);
        for (std::size_t i = 0; i < all.size(); ++i) {
            EXPECT_EQ(all[i].primitive,
                      i == kCenter ? std::optional<PrimitiveId>(1) : std::nullopt);
            EXPECT_EQ(all[i].lit, i == kCenter ? 0b100101u : 0u);
        }
    }
}

TEST(PixelFacts, TellLightsApartBeyondTheBits) {
    Scene scene = two_spheres();
    scene.lights.assign(64, directional({0, 0, -1}));
    const std::uint64_t all_bits = facts(scene, exact_profile())[kCenter].lit;
    EXPECT_EQ(all_bits, ~std::uint64_t{0});
    scene.lights.push_back(directional({0, 0, -1}));
    const std::uint64_t with_one_more = facts(scene, exact_profile())[kCenter].lit;
    EXPECT_NE(with_one_more, all_bits);
    scene.lights.push_back(directional({0, 0, -1}));
    EXPECT_NE(facts(scene, exact_profile())[kCenter].lit, with_one_more);
    EXPECT_NE(facts(scene, exact_profile())[kCenter].lit, all_bits);
    scene.lights[64] = directional({0, 0, 1});  // blocked
    scene.lights.resize(65);
    EXPECT_EQ(facts(scene, exact_profile())[kCenter].lit, all_bits);
}

TEST(PredicateCounts, AreOfTheExactTestsOnly) {
    const Scene scene = two_spheres();
    Profile profile = exact_profile();
    const Primitives primitives = flatten(scene, profile.leaves);
    const Octree octree = build_tree(scene, primitives, profile);
    const auto counts = [&] {
        return count_events(scene, primitives, octree, profile, kThreeByThree);
    };
    ASSERT_TRUE(counts().predicates.has_value());
    // Without lights and with single primitives in the leaves both count the same tests.
    EXPECT_EQ(counts().predicates->tests, counts().intersection_tests);
    profile.precision = Precision::kDouble;
    EXPECT_FALSE(counts().predicates.has_value());
}

}  // namespace
}  // namespace nuvo
