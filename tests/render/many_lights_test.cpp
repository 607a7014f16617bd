#include <gtest/gtest.h>

#include <random>

#include "fast/frame/frame.h"
#include "render/fast_cases.h"

// Shadows found for some lights at a time, because tables of all would take too much memory.

namespace nuvo {
namespace {

constexpr Resolution kSize{96, 64};

std::vector<Light> lamps(std::size_t count, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-4, 4);
    std::vector<Light> lights(count);
    for (Light& light : lights) {
        light.kind = Light::Kind::kPoint;
        light.location = {place(random), place(random), place(random)};
        light.intensity = 1.5 / static_cast<double>(count);
        light.radius = 100;
    }
    return lights;
}

struct Traced {
    Image image;
    std::size_t bytes;
    FastTimes times;
};

Traced traced(const Scene& scene, const Primitives& primitives, ShadowListing listing,
              KeptTables& kept, int threads = 1) {
    const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
    SerialTree serial(fast);
    FastTimes times;
    Frame frame(serial, {OctreeType::kUniform, threads, supported_instruction_sets().back()}, kSize,
                &times, kept, listing);
    Image image = frame.render();
    return {std::move(image), frame.memory_bytes(), times};
}

TEST(ManyLights, AreToldByTheSamePictures) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
        Scene scene = testing::random_scene(seed, 300);
        scene.lights = lamps(7, seed);
        scene.lights[2].casts_shadow = false;
        scene.lights[6].kind = Light::Kind::kDirectional;
        scene.lights[6].direction = {0, -1, 0};
        const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
        const Image expected = testing::exact_picture(scene, primitives, kSize);
        for (const int threads : {1, 3}) {
            KeptTables kept;
            // Tables of all lights are kept for the next picture, those of some are not.
            for (const ShadowListing listing :
                 {ShadowListing::kWanted, ShadowListing::kByLight, ShadowListing::kByLight}) {
                const Traced by_light = traced(scene, primitives, listing, kept, threads);
                EXPECT_EQ(testing::difference(expected, by_light.image), "") << "seed " << seed;
                EXPECT_GT(by_light.times.tables, 0);
                EXPECT_GT(by_light.times.shadow, 0);
                EXPECT_EQ(kept.shadows() == nullptr, listing == ShadowListing::kByLight);
            }
        }
    }
}

TEST(ManyLights, TakeTheMemoryOfOne) {
    Scene scene = testing::random_scene(5, 20'000);
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const auto bytes = [&](std::size_t lights, ShadowListing listing) {
        scene.lights = lamps(lights, 5);
        KeptTables kept;
        return traced(scene, primitives, listing, kept).bytes;
    };
    const std::size_t none = bytes(0, ShadowListing::kWanted);
    const std::size_t most = bytes(12, ShadowListing::kWanted);
    const std::size_t by_light = bytes(12, ShadowListing::kByLight);
    // And a bit for each pixel and light.
    EXPECT_LT(by_light - none, (most - none) / 6 + 12 * 128 * 64 / 8);
}

}  // namespace
}  // namespace nuvo
