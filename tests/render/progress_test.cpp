// What is told of long works: all of it in the end, once each, and nothing else changes.
#include "nuvo/math/progress.h"

#include <gtest/gtest.h>

#include <string>

#include "nuvo/render/fast.h"
#include "nuvo/render/planes.h"
#include "nuvo/scene/x3d.h"

namespace nuvo {
namespace {

constexpr Resolution kOdd{131, 67};  // no multiple of any tile
constexpr std::uint64_t kPixels = 131 * 67;

Scene test2() { return x3d::read_file(NUVO_SOURCE_DIR "/testfiles/both.x3d"); }

void expect_done(const Progress& progress, const std::string& unit, std::uint64_t pieces) {
    EXPECT_EQ(progress.unit(), unit);
    EXPECT_EQ(progress.total(), pieces);
    EXPECT_EQ(progress.done(), pieces);
}

TEST(Progress, OfReadingEndsAtAllShapes) {
    Progress progress;
    x3d::ReadOptions options;
    options.progress = &progress;
    const Scene scene = x3d::read_file(NUVO_SOURCE_DIR "/testfiles/both.x3d", options);
    expect_done(progress, "shapes", scene.shape_count);
}

TEST(Progress, OfTracingCountsPixels) {
    const Scene scene = test2();
    const Profile profile = exact_profile();
    const Primitives primitives = flatten(scene, profile.leaves);
    Progress progress;
    const Octree octree = build_tree(scene, primitives, profile, &progress);
    EXPECT_EQ(progress.unit(), std::string("references"));
    EXPECT_EQ(progress.done(), octree.reference_count());
    EXPECT_GE(progress.total(), octree.reference_count());

    const Image told = render(scene, primitives, octree, profile, kOdd, &progress);
    expect_done(progress, "pixels", kPixels);
    EXPECT_EQ(told, render(scene, primitives, octree, profile, kOdd));
    count_events(scene, primitives, octree, profile, {20, 10}, &progress);
    expect_done(progress, "pixels", 200);
    record_planes(scene, primitives, &octree, profile, {21, 10}, &progress);
    expect_done(progress, "pixels", 210);
    render_facts(scene, primitives, octree, profile, {22, 10}, &progress);
    expect_done(progress, "pixels", 220);
    render_brute_force(scene, primitives, profile, {5, 4}, &progress);
    expect_done(progress, "pixels", 20);
}

TEST(Progress, OfThePublishedBuildHasNoEnd) {
    const Scene scene = test2();
    const Profile profile = thesis_profile();
    Progress progress;
    const Octree octree = build_tree(scene, flatten(scene, profile.leaves), profile, &progress);
    EXPECT_EQ(progress.total(), 0U);
    EXPECT_EQ(progress.done(), octree.reference_count());
}

TEST(Progress, OfTheFastTracerIsTheSameForAnyThreads) {
    const Scene scene = test2();
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    for (const int threads : {1, 3}) {
        Progress progress;
        FastOptions options;
        options.threads = threads;
        Image silent;
        {
            FastTracer tracer(scene, primitives, options);
            silent = tracer.render(kOdd);
        }
        options.progress = &progress;
        FastTracer tracer(scene, primitives, options);
        EXPECT_EQ(progress.unit(), std::string("primitives"));
        EXPECT_EQ(progress.done(), progress.total());
        EXPECT_GE(progress.total(), primitives.sources.size());
        EXPECT_EQ(tracer.render(kOdd), silent);
        expect_done(progress, "pixels", kPixels);
        tracer.count_rays({70, 130});
        expect_done(progress, "pixels", 70 * 130);
        // More rays than are told of at once.
        const std::vector<Ray> rays(100'000, Ray{{0, 0, 800}, {0.001, 0.002, -1}});
        const std::vector<RayAnswer> answers = tracer.closest_hits(rays);
        expect_done(progress, "rays", rays.size());
        const Profile profile = exact_profile();
        const Octree octree = build_tree(scene, primitives, profile);
        const std::vector<Ray> one(1, rays[0]);
        const RayAnswer expected = closest_hits(scene, primitives, &octree, profile, one)[0];
        for (const RayAnswer& answer : {answers.front(), answers[70'000], answers.back()}) {
            EXPECT_EQ(answer.shape, expected.shape);
            EXPECT_EQ(answer.t, expected.t);
        }
    }
}

}  // namespace
}  // namespace nuvo
