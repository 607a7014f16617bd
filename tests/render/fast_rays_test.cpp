// Single rays of the fast tracer against the serial exact one: the same answers, to the last bit of
// t, with every instruction set of the machine.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "fast/rays/few_rays.h"
#include "fast/rays/single_ray.h"
#include "fast_cases.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::testing {
namespace {

namespace fs = std::filesystem;

Bounds3 box_of(const Scene& scene) {
    Bounds3 box;
    for (const Object& object : scene.objects) box = box.extended(bounds(object.shape));
    return box;
}

/// Rays of every kind that is hard for one stage or another, by turns.
class RayMaker {
  public:
    RayMaker(const Scene& scene, std::uint64_t seed)
        : scene_(scene), box_(box_of(scene)), random_(seed) {}

    Ray ray(int kind) {
        const Point3 from = inside();
        switch (kind % 11) {
            case 0:
                return {from, inside() - from};
            case 1:  // along an axis, both other components zero, of either sign
                return {from, axis_direction(0)};
            case 2:  // within a plane across an axis
                return {from, across_axis()};
            case 3:  // at a corner or centre
                return {from, corner() - from};
            case 4:  // from one to another, and from within a surface
                return {corner(), corner() - corner()};
            case 5: {  // from afar
                const double far = std::exp2(uniform(random_, 1, 90));
                const Point3 origin = from + direction() * (far * size());
                return {origin, inside() - origin};
            }
            case 6:  // directions of any length
                return {from, direction() * std::exp2(uniform(random_, -1060, 1020))};
            case 7: {  // beside everything
                const Vector3 way = direction();
                return {from + way * (3 * size()), way};
            }
            case 8:  // nearly along an axis
                return {from, axis_direction(std::exp2(uniform(random_, -1074, -10)))};
            case 9: {  // a largest component that floats round up to a power of two
                Vector3 way = direction() * 0.5;
                way[static_cast<int>(random_() % 3)] =
                    sign() * (1 - std::exp2(uniform(random_, -53, -25)));
                return {from, way * std::exp2(std::round(uniform(random_, -20, 20)))};
            }
            default: {  // an exact diagonal through a corner
                const Vector3 d{sign(), sign(), sign()};
                return {corner() - d * std::exp2(std::ceil(std::log2(size()))), d};
            }
        }
    }

  private:
    double size() const {
        const double width = max_norm(box_.widths());
        return width > 0 ? width : 1;
    }
    double sign() { return (random_() & 1) != 0 ? 1.0 : -1.0; }
    Vector3 direction() { return uniform_point(random_, 1); }
    Point3 inside() {
        const Vector3 w = box_.widths();
        const double x = uniform(random_, -0.1, 1.1);
        const double y = uniform(random_, -0.1, 1.1);
        const double z = uniform(random_, -0.1, 1.1);
        return {box_.min.x + w.x * x, box_.min.y + w.y * y, box_.min.z + w.z * z};
    }
    Point3 corner() {
        const Shape& shape = scene_.objects[random_() % scene_.objects.size()].shape;
        const auto* mesh = std::get_if<TriangleMesh>(&shape);
        if (mesh == nullptr) return middle_of(shape);
        return mesh->positions[random_() % mesh->positions.size()];
    }
    Vector3 axis_direction(double other) {
        Vector3 d{other * sign(), other * sign(), other * sign()};
        d[static_cast<int>(random_() % 3)] = sign();
        return d;
    }
    Vector3 across_axis() {
        Vector3 d = direction();
        d[static_cast<int>(random_() % 3)] = 0.0 * sign();
        return d;
    }

    const Scene& scene_;
    Bounds3 box_;
    std::mt19937_64 random_;
};

std::vector<Ray> rays_for(const Scene& scene, std::uint64_t seed, int count) {
    RayMaker maker(scene, seed);
    std::vector<Ray> rays;
    while (static_cast<int>(rays.size()) < count) {
        const Ray ray = maker.ray(static_cast<int>(rays.size()));
        rays.push_back(ray.direction == Vector3{} ? Ray{ray.origin, {1, 0, 0}} : ray);
    }
    return rays;
}

bool same(const RayAnswer& a, const RayAnswer& b) {
    return a.hit == b.hit && a.shape == b.shape && a.triangle == b.triangle && a.t == b.t;
}

std::string text(const RayAnswer& answer) {
    std::ostringstream out;
    out.precision(17);
    out << (answer.hit ? "hit " : "miss ") << answer.shape << " " << answer.triangle << " at "
        << answer.t;
    return out.str();
}

std::string text(const Ray& ray) {
    std::ostringstream out;
    out << std::hexfloat << ray.origin.x << " " << ray.origin.y << " " << ray.origin.z << " "
        << ray.direction.x << " " << ray.direction.y << " " << ray.direction.z;
    return out.str();
}

/// Of tracers of a few rays each, for they end where a structure for rays would pay.
std::vector<RayAnswer> answers_of_few(const FastScene& fast, std::span<const Ray> rays) {
    std::vector<RayAnswer> answers(rays.size());
    for (std::size_t i = 0; i < rays.size();) {
        const std::size_t answered =
            FewRays(fast).closest_hits(rays.subspan(i), answers.data() + i);
        if (answered == 0) ADD_FAILURE() << "no ray of " << fast.slot_end() << " primitives";
        i += std::max<std::size_t>(answered, 1);
    }
    return answers;
}

/// Compares with brute force; returns the hits.
int expect_equal(const Scene& scene, std::span<const Ray> rays) {
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const auto expected = closest_hits(scene, primitives, nullptr, exact_profile(), rays);
    const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
    const auto compare = [&](const std::vector<RayAnswer>& found, const std::string& by) {
        EXPECT_EQ(found.size(), rays.size());
        for (std::size_t i = 0; i < rays.size(); ++i)
            EXPECT_TRUE(same(found[i], expected[i]))
                << "ray " << i << " " << text(rays[i]) << ", " << by << ": " << text(found[i])
                << " instead of " << text(expected[i]);
    };
    for (const InstructionSet isa : supported_instruction_sets())
        compare(SingleRays(fast, isa).closest_hits(rays),
                "instruction set " + std::to_string(static_cast<int>(isa)));
    compare(answers_of_few(fast, rays), "few rays");
    return static_cast<int>(
        std::count_if(expected.begin(), expected.end(), [](const auto& a) { return a.hit; }));
}

TEST(SingleRays, AnswerAsBruteForceOnAGridWhereEverythingCoincides) {
    for (const std::uint64_t seed : {11, 12}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Scene scene = grid_scene();
        EXPECT_GT(expect_equal(scene, rays_for(scene, seed, 4000)), 400);
    }
}

TEST(SingleRays, AnswerAsBruteForceOnCrossingPrimitivesOfAllSizes) {
    for (const unsigned seed : {21U, 22U, 23U}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Scene scene = random_scene(seed, 300);
        EXPECT_GT(expect_equal(scene, rays_for(scene, seed, 3000)), 600);
    }
}

TEST(SingleRays, AnswerAsBruteForceOnScenesOfEveryShape) {
    int hits = 0;
    for (std::uint64_t seed = 100; seed < 160; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Scene scene = SceneMaker(seed).scene();
        hits += expect_equal(scene, rays_for(scene, seed, 300));
    }
    EXPECT_GT(hits, 2000);
}

TEST(SingleRays, AnswerAsBruteForceAtAnyScaleAndPlace) {
    for (const double scale : {0x1p-1000, 1e-15, 1e-3, 1e15, 0x1p500}) {
        SCOPED_TRACE("scale " + std::to_string(scale));
        Scene scene = random_scene(31, 100);
        transform(scene, scale, {});
        EXPECT_GT(expect_equal(scene, rays_for(scene, 31, 1000)), 100);
    }
    Scene scene = random_scene(32, 100);
    transform(scene, 1, {1e6, -1e6, 3e6});
    EXPECT_GT(expect_equal(scene, rays_for(scene, 32, 1000)), 100);
}

// Grids of leaves: tiny shapes beside and within huge ones.
TEST(SingleRays, AnswerAsBruteForceWhereTinyAndHugeMeet) {
    std::mt19937_64 random(41);
    Scene scene;
    TriangleMesh floor;
    floor.positions = {{-1e4, -1e4, 0}, {1e4, -1e4, 0}, {0, 1e4, 0}};
    floor.triangles = {{0, 1, 2}};
    scene.objects.push_back({floor});
    scene.objects.push_back({Sphere{{0, 0, -1e6}, 1e6}});
    for (int i = 0; i < 300; ++i) {
        const double size = std::exp2(uniform(random, -30, 0));
        const Point3 center = uniform_point(random, 2);
        if (i % 3 == 0)
            scene.objects.push_back({Sphere{center, size}});
        else
            scene.objects.push_back({octahedron(center, size)});
    }
    finish(scene);
    EXPECT_GT(expect_equal(scene, rays_for(scene, 41, 3000)), 1000);
}

// Flat scenes: a few triangles as wide as all, which stand apart at the root, small ones on them,
// and rays hardly inclined to them.
TEST(SingleRays, AnswerAsBruteForceOverFloorsOfAnyWidth) {
    for (const double width : {8.0, 1e3, 1e6, 1e12}) {
        SCOPED_TRACE("width " + std::to_string(width));
        Scene scene;
        TriangleMesh floor;
        floor.positions = {{-width, -width, 0}, {width, -width, 0},   {width, width, 0},
                           {-width, width, 0},  {-width, -width, -1}, {width, width, -1}};
        floor.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 1}};
        scene.objects.push_back({floor});
        std::mt19937_64 random(43);
        for (int i = 0; i < 60; ++i) {
            const double size = uniform(random, 0.05, 0.2);
            const Point3 at = uniform_point(random, 2);
            scene.objects.push_back({octahedron({at.x, at.y, size}, size)});
        }
        finish(scene);
        EXPECT_GT(expect_equal(scene, rays_for(scene, 43, 1000)), 200);
    }
}

// Vectors of doubles say of a pair only what the exact predicates say, and leave little open.
TEST(PairRoots, AreThoseOfTheExactPredicates) {
    std::mt19937_64 random(44);
    const auto coordinate = [&] { return static_cast<double>(random() % 9) - 4; };
    const auto point = [&](int kind) -> Point3 {  // on a grid, where much is zero; or anywhere
        if (kind == 0) return {coordinate(), coordinate(), coordinate()};
        return uniform_point(random, kind == 1 ? 4 : 0x1p-300);
    };
    for (const InstructionSet isa : supported_instruction_sets()) {
        SCOPED_TRACE("instruction set " + std::to_string(static_cast<int>(isa)));
        const PairRootStage stage(isa);
        int open = 0;
        int hits = 0;
        for (int round = 0; round < 600; ++round) {
            PairRoots roots;
            std::array<Ray, PairRoots::kCount> rays;
            std::array<Triangle, PairRoots::kCount> triangles;
            for (std::size_t i = 0; i < PairRoots::kCount; ++i) {
                const int kind = round % 3;
                const Point3 origin = point(kind);
                rays[i] = {origin, point(kind) - origin};
                triangles[i] = {point(kind), point(kind), point(kind)};
                roots.set(i, rays[i], triangles[i].a, triangles[i].b, triangles[i].c);
            }
            roots.front_only = static_cast<std::uint32_t>(random());
            stage.find_triangles(roots, PairRoots::kCount);
            for (std::size_t i = 0; i < PairRoots::kCount; ++i) {
                const auto bit = [i](std::uint32_t bits) { return (bits >> i & 1) != 0; };
                StageCounts counts;
                const auto root = hit(ExactRay(rays[i]), triangles[i], counts,
                                      bit(roots.front_only) ? Sides::kFront : Sides::kBoth);
                hits += bit(roots.hit);
                open += round % 3 == 1 && !bit(roots.hit) && !bit(roots.missed);
                EXPECT_FALSE(bit(roots.hit) && bit(roots.missed));
                if (bit(roots.hit)) {
                    ASSERT_TRUE(root) << "round " << round << ", pair " << i;
                    EXPECT_EQ(roots.t[i], root->t) << "round " << round << ", pair " << i;
                }
                if (bit(roots.missed)) {
                    EXPECT_FALSE(root) << "round " << round << ", pair " << i;
                }
            }
        }
        EXPECT_GT(hits, 200);
        EXPECT_LT(open, 100);  // of 6,400
    }
}

TEST(PairRoots, OfSpheresAreThoseOfTheExactPredicates) {
    std::mt19937_64 random(45);
    for (const InstructionSet isa : supported_instruction_sets()) {
        SCOPED_TRACE("instruction set " + std::to_string(static_cast<int>(isa)));
        const PairRootStage stage(isa);
        int found = 0;
        int hits = 0;
        for (int round = 0; round < 600; ++round) {
            PairRoots roots;
            std::array<Ray, PairRoots::kCount> rays;
            std::array<Sphere, PairRoots::kCount> spheres;
            for (std::size_t i = 0; i < PairRoots::kCount; ++i) {
                // Origins outside, inside, and now and then on the surface; tangents, too.
                const double size = round % 8 == 7 ? 0x1p-500 : 1;
                const Point3 origin = uniform_point(random, 4 * size);
                rays[i] = {origin, uniform_point(random, size) - origin};
                spheres[i] = {uniform_point(random, size), uniform(random, 0, 3) * size};
                if (i % 8 == 0) rays[i] = {{2, 0, 0}, {0, 1, 0}};
                if (i % 8 == 0) spheres[i] = {{static_cast<double>(random() % 3), 0, 0}, 2};
                roots.set(i, rays[i], spheres[i]);
            }
            roots.front_only = static_cast<std::uint32_t>(random());
            stage.find_spheres(roots, PairRoots::kCount);
            for (std::size_t i = 0; i < PairRoots::kCount; ++i) {
                const bool front = (roots.front_only >> i & 1) != 0;
                StageCounts counts;
                const auto expected = hit(ExactRay(rays[i]), spheres[i], counts,
                                          front ? Sides::kFront : Sides::kBoth);
                hits += expected.has_value();
                if ((roots.found >> i & 1) == 0) continue;
                ++found;
                ASSERT_TRUE(expected) << "round " << round << ", pair " << i;
                EXPECT_EQ(roots.t[i], expected->root.t) << "round " << round << ", pair " << i;
            }
        }
        EXPECT_GT(found, 5000);
        EXPECT_GT(found, hits * 3 / 4);
    }
}

// More of the same than a leaf's counts hold, and equal t throughout.
TEST(SingleRays, TakeTheFirstOfHundredsThatCoincide) {
    Scene scene;
    for (int i = 0; i < 300; ++i) scene.objects.push_back({octahedron({0, 0, 0}, 1)});
    scene.objects.push_back({Sphere{{5, 0, 0}, 1}});
    finish(scene);
    const std::vector<Ray> rays = {{{0.1, 0.2, 9}, {0, 0, -1}}, {{9, 0.1, 0.2}, {-1, 0, 0}}};
    EXPECT_EQ(expect_equal(scene, rays), 2);
    EXPECT_GT(expect_equal(scene, rays_for(scene, 51, 40)), 8);
}

// More triangles than are kept undecided, so near each other that floats cannot order them, met
// along directions a little shorter than a power of two, to which floats round them.
TEST(SingleRays, OrderManyThatFloatsCannotTellApart) {
    constexpr int kDepths[] = {2,  18, 10, 23, 32, 31, 7, 21, 17, 5,  1,  9,  22, 19, 11, 33, 27,
                               25, 13, 28, 0,  26, 30, 6, 12, 20, 29, 14, 24, 15, 3,  16, 4,  8};
    TriangleMesh mesh;
    for (const int depth : kDepths) {
        const double z = 1e-9 * depth;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Point3& corner : {Point3{-1, -1, z}, Point3{1, -1, z}, Point3{0, 1, z}})
            mesh.positions.push_back(corner);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    Scene scene;
    scene.objects.push_back({mesh});
    scene.objects.back().solid = false;
    finish(scene);
    std::vector<Ray> rays;
    for (const double length : {1 - 1e-11, 1 - 0x1p-30, 1.0, 2 - 0x1p-40, 0.25 - 0x1p-40, 1.5})
        for (const double from : {2.0, -2.0})
            rays.push_back({{0, 0, from}, {0, 0, from > 0 ? -length : length}});
    EXPECT_EQ(expect_equal(scene, rays), 12);
}

// Triangles in one plane, and others that a corner takes out of it by a few roundings: the nearer
// one is now the earlier, now the later of the document.
TEST(SingleRays, TellTrianglesInOnePlaneFromNearlyCoincidentOnes) {
    constexpr unsigned kSeed = 53;
    std::mt19937_64 random(kSeed);
    Scene scene;
    for (int i = 0; i < 60; ++i) {
        TriangleMesh mesh;
        for (int k = 0; k < 3; ++k) {
            // On a grid, so that a third coordinate from both of them is exact.
            const double x = static_cast<double>(random() % 4096) / 1024 - 2;
            const double y = static_cast<double>(random() % 4096) / 1024 - 2;
            const bool moved = i % 2 != 0 && k == i / 2 % 3;
            const double roundings = moved ? std::nearbyint(uniform(random, -3, 3)) : 0;
            mesh.positions.push_back({x, y, 1 + x / 4 - y / 2 + roundings * 0x1p-51});
        }
        mesh.triangles = {{0, 1, 2}};
        scene.objects.push_back({mesh});
    }
    finish(scene);
    std::vector<Ray> rays;
    for (int i = 0; i < 2000; ++i) {
        const Point3 from =
            uniform_point(random, 2) + Vector3{0, 0, random() % 2 == 0 ? 6.0 : -6.0};
        rays.push_back({from, uniform_point(random, 1.5) - from});
    }
    EXPECT_GT(expect_equal(scene, rays), 1000);
}

TEST(SingleRays, MissWhereThereIsNothing) {
    Scene scene;
    finish(scene);
    const std::vector<Ray> rays = {{{0, 0, 9}, {0, 0, -1}}, {{0, 0, 0}, {1, 2, 3}}};
    EXPECT_EQ(expect_equal(scene, rays), 0);
    EXPECT_EQ(expect_equal(grid_scene(), {}), 0);
}

// By hand: a triangle at z = 0 met from z = 2 at half the length of the direction.
TEST(SingleRays, MeasureInUnitsOfTheDirection) {
    Scene scene;
    TriangleMesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    scene.objects.push_back({mesh});
    finish(scene);
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    FastTracer tracer(scene, primitives, {});
    const std::vector<Ray> rays = {{{0, 0, 2}, {0, 0, -4}}, {{0, 0, 2}, {0, 0, 4}}};
    const auto answers = tracer.closest_hits(rays);
    EXPECT_TRUE(answers[0].hit);
    EXPECT_EQ(answers[0].t, 0.5);
    EXPECT_FALSE(answers[1].hit);
    EXPECT_EQ(answers[1].t, std::numeric_limits<double>::infinity());
}

// Through the serial tracer's octree, which brute force has checked: too many for brute force.
TEST(SingleRays, AnswerAsTheSerialTracerOnTheThesisScenes) {
    for (const char* name : {"teapot", "trianglemesh", "both", "concentric", "clumped"}) {
        SCOPED_TRACE(name);
        const Scene scene =
            x3d::read_file(fs::path(NUVO_SOURCE_DIR) / "testfiles" / (std::string(name) + ".x3d"));
        const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
        const Octree octree = build_tree(scene, primitives, exact_profile());
        std::vector<Ray> rays;  // without those from too far and too long: all go by brute force
        for (const Ray& ray : rays_for(scene, 61, 10000))
            if (max_norm(ray.direction) > 0x1p-800 && max_norm(ray.direction) < 0x1p800)
                rays.push_back(ray);
        const auto expected = closest_hits(scene, primitives, &octree, exact_profile(), rays);
        const FastScene fast(scene, primitives, OctreeType::kNonuniform, 1);
        for (const InstructionSet isa : supported_instruction_sets()) {
            const auto found = SingleRays(fast, isa).closest_hits(rays);
            int different = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) different += !same(found[i], expected[i]);
            EXPECT_EQ(different, 0) << "instruction set " << static_cast<int>(isa);
        }
    }
}

}  // namespace
}  // namespace nuvo::testing
