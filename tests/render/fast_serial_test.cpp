// Where floats tell too little of a scene the fast tracer hands what is left to the serial tracer:
// the answers stay, and nobody waits for them.
#include <gtest/gtest.h>

#include <filesystem>

#include "fast/rays/single_ray.h"
#include "fast/shadow/shadow_tables.h"
#include "fast_cases.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::testing {
namespace {

constexpr Resolution kSize{160, 90};

struct Subject {
    explicit Subject(const std::string& file)
        : Subject(x3d::read_file(std::filesystem::path(NUVO_SOURCE_DIR) / file)) {}
    explicit Subject(Scene given)
        : scene(std::move(given)),
          primitives(flatten(scene, LeafContent::kPrimitives)),
          fast(scene, primitives, OctreeType::kUniform, 1),
          serial(fast) {}

    Image picture(int threads = 1, ShadowListing listing = ShadowListing::kAll) {
        KeptTables kept;
        const FastOptions options{OctreeType::kUniform, threads};
        return Frame(serial, options, kSize, nullptr, kept, listing).render();
    }
    std::vector<RayAnswer> hits(std::span<const Ray> rays) {
        return SingleRays(fast, InstructionSet::kBest).closest_hits(rays, nullptr, &serial);
    }
    std::vector<Ray> rays() const {
        const RayGenerator camera(scene.camera, kSize);
        std::vector<Ray> rays;
        for (int y = 0; y < kSize.height; ++y)
            for (int x = 0; x < kSize.width; ++x) rays.push_back(camera.ray(x, y));
        return rays;
    }

    Scene scene;
    Primitives primitives;
    FastScene fast;
    SerialTree serial;
};

TEST(SerialTree, IsNotBuiltForOrdinaryScenes) {
    for (const char* file : {"testfiles/both.x3d", "testfiles/teapot.x3d"}) {
        SCOPED_TRACE(file);
        Subject subject(file);
        subject.picture();
        subject.hits(subject.rays());
        EXPECT_FALSE(subject.serial.is_built());
        Scene parallel = subject.scene;
        parallel.camera = parallel_camera(parallel.camera, length(parallel.camera.position));
        Subject other(parallel);
        other.picture();
        EXPECT_FALSE(other.serial.is_built());
    }
}

// A bundle of thin cylinders stands in many voxels and in thousands of entries of each light's
// lists; the serial tracer's octree would cost ten times the picture.
TEST(SerialTree, IsNotBuiltForLongThinTriangles) {
    std::mt19937_64 random(60);
    std::string shapes;
    for (int i = 0; i < 120; ++i) {
        const auto number = [&](double least, double most) {
            return std::to_string(uniform(random, least, most)) + " ";
        };
        shapes += "<Transform translation='" + number(-2, 2) + "0 " + number(-2, 2) +
                  "' rotation='1 0 1 " + number(-0.2, 0.2) +
                  "'><Shape><Appearance><Material/></Appearance><Cylinder radius='0.02' "
                  "height='12'/></Shape></Transform>";
    }
    Subject subject(
        x3d::read_text("<X3D version='3.3'><Scene><Viewpoint position='0 0 10'/>"
                       "<PointLight location='3 8 10'/>" +
                           shapes + "</Scene></X3D>",
                       "scene"));
    const ShadowTables tables(subject.fast, InstructionSet::kBest);
    EXPECT_TRUE(tables.table(0).buffer.long_lists);
    const Image expected = exact_picture(subject.scene, subject.primitives, kSize);
    for (const ShadowListing listing : {ShadowListing::kAll, ShadowListing::kWanted})
        EXPECT_EQ(difference(expected, subject.picture(1, listing)), "");
    EXPECT_FALSE(subject.serial.is_built());
}

TEST(SerialTree, ServesPixelsThatFloatsTellNothingOf) {
    Subject subject("tests/fuzz/findings/small-shapes-beside-1e200.x3d");
    const Image expected = exact_picture(subject.scene, subject.primitives, kSize);
    for (const int threads : {1, 3})
        for (const ShadowListing listing : {ShadowListing::kAll, ShadowListing::kWanted})
            EXPECT_EQ(difference(expected, subject.picture(threads, listing)), "");
    EXPECT_TRUE(subject.serial.is_built());
}

// All spheres coincide but for their last bits: primary rays alone are too much for the fallback.
TEST(SerialTree, ServesPixelsBeforeAnyIsShaded) {
    std::string shapes;
    for (int i = 0; i < 400; ++i)
        shapes +=
            "<Transform translation='" + std::to_string(i) +
            "e-18 0 0'><Shape><Appearance><Material/></Appearance><Sphere/></Shape></Transform>";
    Subject subject(x3d::read_text(
        "<X3D version='3.3'><Scene><Viewpoint position='0 0 4'/>" + shapes + "</Scene></X3D>",
        "scene"));
    const Image expected = exact_picture(subject.scene, subject.primitives, kSize);
    for (const ShadowListing listing : {ShadowListing::kAll, ShadowListing::kWanted})
        EXPECT_EQ(difference(expected, subject.picture(3, listing)), "");
    EXPECT_TRUE(subject.serial.is_built());
}

TEST(SerialTree, ServesRaysThatFloatsTellNothingOf) {
    Subject subject("tests/fuzz/findings/rays-that-floats-lose.x3d");
    const std::vector<Ray> rays = subject.rays();
    const auto expected = closest_hits(subject.scene, subject.primitives, &subject.serial.octree(),
                                       exact_profile(), rays);
    Subject again("tests/fuzz/findings/rays-that-floats-lose.x3d");
    const auto found = again.hits(rays);
    EXPECT_TRUE(again.serial.is_built());
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].hit, expected[i].hit);
        EXPECT_EQ(found[i].t, expected[i].t);
    }
}

// Floats would let rays into boxes without end, or past what is there.
TEST(SerialTree, ServesScenesThatReachBeyondTheDoubles) {
    Scene scene;
    scene.materials.resize(1);
    Ellipsoid thin{{0, 0, 0}, {}, 1e9};
    thin.linear.row[2].z = 1e300;
    scene.objects.push_back({Sphere{{0, 0, 0}, 1}, 0, 0, false});
    scene.objects.push_back({thin, 0, 1, false});
    scene.shape_count = 2;
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const std::vector<Ray> rays = {
        {{0, 0, 0}, {0, 0, 1}}, {{3e9, 0, 0}, {-1, 0, 0}}, {{-8, -0.25, 0}, {1, 0.01, 0}}};
    const auto expected = closest_hits(scene, primitives, nullptr, exact_profile(), rays);
    FastTracer tracer(scene, primitives, {});
    const auto found = tracer.closest_hits(rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(found[i].hit, expected[i].hit);
        EXPECT_EQ(found[i].shape, expected[i].shape);
        EXPECT_EQ(found[i].t, expected[i].t);
    }
    EXPECT_TRUE(expected[0].hit && expected[1].hit && expected[2].hit);
    EXPECT_EQ(difference(exact_picture(scene, primitives, {32, 18}), tracer.render({32, 18})), "");
}

}  // namespace
}  // namespace nuvo::testing
