#include <benchmark/benchmark.h>

#include <random>

#include "nuvo/geometry/predicates.h"
#include "nuvo/octree/build.h"
#include "nuvo/octree/walk.h"
#include "nuvo/render/fast.h"
#include "nuvo/scene/x3d.h"

// The inner loops one by one, on random input of a fixed seed and on two of the test files:
// nuvo_kernels [--benchmark_filter=NAME], from the project's root.

namespace nuvo {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr std::size_t kPairs = 4096;
constexpr const char* kSmallScene = "testfiles/both.x3d";
constexpr const char* kMeshScene = "testfiles/teapot.x3d";

class Random {
  public:
    double unit() { return unit_(engine_); }
    Point3 point() {
        const double x = unit();
        const double y = unit();
        return {x, y, unit()};
    }
    /// From one point of the unit box through another.
    Ray ray() {
        const Point3 from = point();
        return {from, normalized(point() - from)};
    }

  private:
    std::mt19937_64 engine_{kSeed};
    std::uniform_real_distribution<double> unit_{0, 1};
};

template <typename Primitive, typename Make>
void test_hits(benchmark::State& state, Make&& make) {
    Random random;
    std::vector<ExactRay> rays;
    std::vector<Primitive> primitives;
    for (std::size_t i = 0; i < kPairs; ++i) {
        rays.emplace_back(random.ray(), Bounds3{{0, 0, 0}, {1, 1, 1}});
        primitives.push_back(make(random));
    }
    StageCounts counts;
    for (auto _ : state)
        for (std::size_t i = 0; i < kPairs; ++i)
            benchmark::DoNotOptimize(hit(rays[i], primitives[i], counts));
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * kPairs));
}

void triangle_hit(benchmark::State& state) {
    test_hits<Triangle>(state, [](Random& random) {
        const Point3 a = random.point();
        const Point3 b = random.point();
        return Triangle{a, b, random.point()};
    });
}
BENCHMARK(triangle_hit);

void sphere_hit(benchmark::State& state) {
    test_hits<Sphere>(state, [](Random& random) {
        const Point3 center = random.point();
        return Sphere{center, 0.3 * random.unit()};
    });
}
BENCHMARK(sphere_hit);

std::vector<Bounds3> random_boxes(std::size_t count) {
    constexpr double kSize = 0.02;
    Random random;
    std::vector<Bounds3> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const Point3 corner = random.point() * (1 - kSize);
        boxes.push_back({corner, corner + Vector3{kSize, kSize, kSize}});
    }
    return boxes;
}

/// An item is one step from leaf to leaf.
template <typename Locator>
void walk_step(benchmark::State& state) {
    Octree octree = build_octree(random_boxes(10'000));
    octree.make_names();
    Random random;
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < kPairs; ++i) rays.push_back(random.ray());
    ExactWalk<Locator> walk(octree);
    std::int64_t steps = 0;
    for (auto _ : state)
        for (const Ray& ray : rays)
            walk(ray, std::numeric_limits<double>::infinity(), [&](const Node& leaf, double) {
                benchmark::DoNotOptimize(&leaf);
                ++steps;
                return false;
            });
    state.SetItemsProcessed(steps);
}
BENCHMARK(walk_step<HashLocator>);
BENCHMARK(walk_step<DescentLocator>);

template <std::optional<Point3> (*kStrategy)(const SplitQuery&)>
void midpoint_search(benchmark::State& state) {
    const std::vector<Bounds3> boxes = random_boxes(static_cast<std::size_t>(state.range(0)));
    const Voxel voxel = Voxel::centered({{0, 0, 0}, {1, 1, 1}});
    for (auto _ : state) benchmark::DoNotOptimize(kStrategy({voxel, boxes}));
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * state.range(0));
}
BENCHMARK(midpoint_search<sweep_midpoint>)->Arg(100)->Arg(10'000);
BENCHMARK(midpoint_search<published_midpoint>)->Arg(100)->Arg(10'000);

void load_scene(benchmark::State& state, const char* file) {
    for (auto _ : state) benchmark::DoNotOptimize(x3d::read_file(file));
}
BENCHMARK_CAPTURE(load_scene, both, kSmallScene)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(load_scene, teapot, kMeshScene)->Unit(benchmark::kMillisecond);

/// An item is a primitive.
void build_reference_tree(benchmark::State& state, const char* file) {
    const Scene scene = x3d::read_file(file);
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    for (auto _ : state) benchmark::DoNotOptimize(build_tree(scene, primitives, exact_profile()));
    state.SetItemsProcessed(
        static_cast<std::int64_t>(state.iterations() * primitives.sources.size()));
}
BENCHMARK_CAPTURE(build_reference_tree, both, kSmallScene)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build_reference_tree, teapot, kMeshScene)->Unit(benchmark::kMillisecond);

/// An item is a primitive.
void build_fast_tree(benchmark::State& state, const char* file, OctreeType type) {
    const Scene scene = x3d::read_file(file);
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    FastOptions options;
    options.type = type;
    for (auto _ : state) benchmark::DoNotOptimize(FastTracer(scene, primitives, options));
    state.SetItemsProcessed(
        static_cast<std::int64_t>(state.iterations() * primitives.sources.size()));
}
BENCHMARK_CAPTURE(build_fast_tree, test2_uniform, kSmallScene, OctreeType::kUniform)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build_fast_tree, test2_nonuniform, kSmallScene, OctreeType::kNonuniform)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build_fast_tree, teapot_uniform, kMeshScene, OctreeType::kUniform)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build_fast_tree, teapot_nonuniform, kMeshScene, OctreeType::kNonuniform)
    ->Unit(benchmark::kMillisecond);

/// Rays from anywhere in the scene's box to anywhere; an item is a ray.
void single_rays(benchmark::State& state, const char* file) {
    const Scene scene = x3d::read_file(file);
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    Bounds3 box;
    for (const Bounds3& item : primitives.item_boxes) box = box.extended(item);
    Random random;
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < kPairs; ++i) {
        const Ray ray = random.ray();
        rays.push_back({box.min + ray.origin * box.widths(), ray.direction});
    }
    FastTracer tracer(scene, primitives, {});
    for (auto _ : state) benchmark::DoNotOptimize(tracer.closest_hits(rays));
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * kPairs));
}
BENCHMARK_CAPTURE(single_rays, both, kSmallScene)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(single_rays, teapot, kMeshScene)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace nuvo

BENCHMARK_MAIN();
