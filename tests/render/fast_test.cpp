// The fast tracer against the serial exact one: the same bytes on every scene of the project and on
// random ones, with every instruction set of the machine, number of threads and octree.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "fast_cases.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::testing {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> scene_files() {
    std::vector<std::string> names;
    const fs::path root = fs::path(NUVO_SOURCE_DIR) / "testfiles";
    for (const auto& entry : fs::recursive_directory_iterator(root))
        if (entry.path().extension() == ".x3d")
            names.push_back(fs::relative(entry.path(), root).string());
    std::sort(names.begin(), names.end());
    return names;
}

class FastFile : public ::testing::TestWithParam<std::string> {
  protected:
    Scene scene_ = x3d::read_file(fs::path(NUVO_SOURCE_DIR) / "testfiles" / GetParam());
};

TEST_P(FastFile, IsRenderedToTheSameBytes) {
    expect_identical(scene_, {{120, 67}, {1, 1}, {17, 33}, {250, 3}, {3, 40}}, {1, 2, 7});
}

TEST_P(FastFile, IsRenderedToTheSameBytesFromOddPlaces) {
    for (const Camera& camera : odd_cameras(scene_)) {
        scene_.camera = camera;
        std::ostringstream place;
        place << "camera at " << camera.position.x << " " << camera.position.y << " "
              << camera.position.z << " along " << camera.forward.x << " " << camera.forward.y
              << " " << camera.forward.z;
        SCOPED_TRACE(place.str());
        expect_identical(scene_, {{40, 30}});
    }
}

TEST_P(FastFile, CountsTheRaysOfTheSerialTracer) {
    const Primitives primitives = flatten(scene_, LeafContent::kPrimitives);
    const Profile profile = exact_profile();
    constexpr Resolution kSize{60, 34};
    const TraceCounts expected =
        count_events(scene_, primitives, build_tree(scene_, primitives, profile), profile, kSize);
    const RayCounts counts = FastTracer(scene_, primitives, {}).count_rays(kSize);
    EXPECT_EQ(counts.primary_rays, expected.primary_rays);
    EXPECT_EQ(counts.shadow_rays, expected.shadow_rays);
}

INSTANTIATE_TEST_SUITE_P(Testfiles, FastFile, ::testing::ValuesIn(scene_files()),
                         [](const auto& parameter) {
                             std::string name = parameter.param;
                             for (char& c : name)
                                 if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
                             return name;
                         });

// NUVO_FAST_SEED repeats a run.
std::uint64_t chosen_seed() {
    const char* const given = std::getenv("NUVO_FAST_SEED");
    return given != nullptr ? std::strtoull(given, nullptr, 10) : std::random_device{}();
}

TEST(Fast, RandomScenesAreRenderedToTheSameBytes) {
    const std::uint64_t seed = chosen_seed();
    for (std::uint64_t i = 0; i < 60; ++i) {
        SCOPED_TRACE("NUVO_FAST_SEED=" + std::to_string(seed) + " scene " + std::to_string(i));
        expect_identical(SceneMaker(seed + i).scene(), {{64, 48}}, {1, 3});
    }
}

// An ellipsoid beside a light lost its shadow in one of them.
TEST(Fast, TheRandomScenesThatDifferedOnceAreRenderedToTheSameBytes) {
    for (std::uint64_t i = 0; i < 60; ++i) {
        SCOPED_TRACE("scene " + std::to_string(i));
        expect_identical(SceneMaker(3854069501 + i).scene(), {{64, 48}});
    }
}

TEST(Fast, DeepOctreesAreRenderedToTheSameBytes) {
    const auto seed = static_cast<unsigned>(chosen_seed());
    SCOPED_TRACE("NUVO_FAST_SEED=" + std::to_string(seed));
    for (Scene scene : {random_scene(seed, 3000), grid_scene()}) {
        expect_identical(scene, {{96, 54}}, {1, 2});
        for (const Camera& camera : odd_cameras(scene)) {
            scene.camera = camera;
            expect_identical(scene, {{40, 30}});
        }
    }
}

TEST(Fast, RandomScenesOfAnyScaleAndPlaceAreRenderedToTheSameBytes) {
    const std::uint64_t seed = chosen_seed();
    for (const double scale : {1e-15, 1e-6, 1e6, 1e15})
        for (std::uint64_t i = 0; i < 4; ++i) {
            std::ostringstream trace;
            trace << "NUVO_FAST_SEED=" << seed << " scene " << i << " times " << scale;
            SCOPED_TRACE(trace.str());
            Scene scene = SceneMaker(seed + 1000 + i).scene();
            transform(scene, scale, {});
            expect_identical(scene, {{48, 32}});
        }
    for (std::uint64_t i = 0; i < 4; ++i) {
        SCOPED_TRACE("NUVO_FAST_SEED=" + std::to_string(seed) + " moved scene " +
                     std::to_string(i));
        Scene scene = SceneMaker(seed + 2000 + i).scene();
        transform(scene, 1, {1e6, -2e6, 3e5});
        expect_identical(scene, {{48, 32}});
    }
}

/// A rough ground of 2 n^2 triangles, 2 wide, under a sun and a lamp.
Scene rough_ground(int n) {
    TriangleMesh mesh;
    std::mt19937_64 random(1);
    for (int row = 0; row <= n; ++row)
        for (int column = 0; column <= n; ++column)
            mesh.positions.push_back(
                {2.0 * column / n - 1, uniform(random, 0, 3.0 / n), 2.0 * row / n - 1});
    const auto place = [n](int row, int column) {
        return static_cast<std::uint32_t>(row * (n + 1) + column);
    };
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            const std::uint32_t a = place(row, column);
            const std::uint32_t b = place(row + 1, column);
            mesh.triangles.push_back({a, b, b + 1});
            mesh.triangles.push_back({a, b + 1, a + 1});
        }
    Scene scene;
    scene.materials.emplace_back();
    Object object;
    object.shape = std::move(mesh);
    object.solid = false;
    scene.objects.push_back(std::move(object));
    scene.lights.resize(2);
    scene.lights[0].direction = normalized(Vector3{0.5, -1, 0.3});
    scene.lights[1].kind = Light::Kind::kPoint;
    scene.lights[1].location = {0.2, 0.3, 0.1};
    return scene;
}

// So many that shadows are listed as what is seen decides: for all of them, twice, and for few.
TEST(Fast, ManyTrianglesSeenFromAfarAndFromNearbyAreRenderedToTheSameBytes) {
    Scene scene = rough_ground(230);
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    constexpr Resolution kSize{200, 130};
    FastTracer tracer(scene, primitives, {{}, 2});
    for (const Point3& eye : {Point3{0, 2.2, 0.1}, Point3{0, 2.2, 0.1}, Point3{0.3, 0.05, 0.2}}) {
        scene.camera = camera_along(eye, Vector3{} - (eye - Point3{}));
        EXPECT_EQ(difference(exact_picture(scene, primitives, kSize), tracer.render(kSize)), "")
            << "eye at height " << eye.y;
    }
}

// Tables of shadows are kept from one picture to the next.
TEST(Fast, LightsAndCamerasThatMoveBetweenPicturesGiveNewShadows) {
    Scene scene = grid_scene();
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    constexpr Resolution kSize{64, 48};
    FastTracer tracer(scene, primitives, {});
    const std::vector<Camera> cameras = odd_cameras(scene);
    for (std::size_t i = 0; i < 6; ++i) {
        scene.lights.resize(1 + i / 3);
        scene.lights.back().direction =
            normalized(Vector3{0.3 * static_cast<double>(i) - 0.5, -1, 0.4});
        scene.camera = cameras[i / 2 % cameras.size()];
        EXPECT_EQ(difference(exact_picture(scene, primitives, kSize), tracer.render(kSize)), "")
            << "picture " << i;
    }
}

TEST(Fast, ScenesWithoutObjectsOrLightsAreRenderedToTheSameBytes) {
    const std::uint64_t seed = chosen_seed();
    SCOPED_TRACE("NUVO_FAST_SEED=" + std::to_string(seed));
    Scene scene = SceneMaker(seed).scene();
    scene.lights.clear();
    expect_identical(scene, {{33, 17}}, {1, 2});
    scene.objects.clear();
    scene.shape_count = 0;
    scene.background = {{{0.1, 0.2, 0.3}, {0.9, 0.5, 0.1}}, {1}, {{0, 1, 0}}, {}};
    expect_identical(scene, {{33, 17}}, {1, 2});
}

TEST(Fast, RaysAreAnsweredAsTheSerialTracerAnswers) {
    const std::uint64_t seed = chosen_seed();
    SCOPED_TRACE("NUVO_FAST_SEED=" + std::to_string(seed));
    for (std::uint64_t i = 0; i < 20; ++i) {
        SceneMaker maker(seed + i);
        const Scene scene = maker.scene();
        const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
        std::vector<Ray> rays;
        for (int k = 0; k < 200; ++k) rays.push_back(maker.ray());
        const auto expected = closest_hits(scene, primitives, nullptr, exact_profile(), rays);
        for (const OctreeType type : kTypes)
            for (const InstructionSet isa : supported_instruction_sets()) {
                FastTracer tracer(scene, primitives, {type, 1, isa});
                const auto answers = tracer.closest_hits(rays);
                ASSERT_EQ(answers.size(), expected.size());
                for (std::size_t k = 0; k < rays.size(); ++k) {
                    EXPECT_EQ(answers[k].hit, expected[k].hit) << i << " ray " << k;
                    EXPECT_EQ(answers[k].shape, expected[k].shape) << i << " ray " << k;
                    EXPECT_EQ(answers[k].triangle, expected[k].triangle) << i << " ray " << k;
                    EXPECT_EQ(answers[k].t, expected[k].t) << i << " ray " << k;
                }
            }
    }
}

TEST(Fast, OneTracerRendersMoreThanOnce) {
    const std::uint64_t seed = chosen_seed();
    SCOPED_TRACE("NUVO_FAST_SEED=" + std::to_string(seed));
    const Scene scene = SceneMaker(seed).scene();
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    FastTracer tracer(scene, primitives, {OctreeType::kUniform, 2});
    FastTimes times;
    const Image first = tracer.render({50, 40}, &times);
    tracer.render({20, 70});
    EXPECT_EQ(difference(first, tracer.render({50, 40})), "");
    EXPECT_GT(times.primary, 0);
    EXPECT_GT(tracer.memory().structure, 0u);
}

}  // namespace
}  // namespace nuvo::testing
