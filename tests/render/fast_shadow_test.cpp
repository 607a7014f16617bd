#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>

#include "exact_kernel.h"
#include "fast/shadow/shadow.h"
#include "fast/simd/dispatch.h"
#include "nuvo/render/render.h"
#include "nuvo/render/shading.h"
#include "nuvo/scene/x3d.h"
#include "property/test_scenes.h"

namespace nuvo {
namespace {

using testing::uniform;
using testing::uniform_point;

constexpr double kFloatRoundoff = 0x1p-24;

/// Tiles filled from exact hits, and the stage under test, for one scene.
class ShadowPicture {
    using Kernel = ExactKernelOf<SceneStore>;

  public:
    ShadowPicture(const Scene& scene, Resolution size, OctreeType type = OctreeType::kUniform)
        : scene_(scene),
          size_(size),
          primitives_(flatten(scene, LeafContent::kPrimitives)),
          fast_(scene, primitives_, type, 1),
          camera_(scene.camera, size, fast_.frame()),
          triangles_(primitives_.kind(PrimitiveKind::kTriangle).box),
          fallback_(fast_, camera_),
          kernel_(scene, primitives_, std::nullopt) {
        Profile profile = exact_profile();
        profile.walk = WalkChoice::kDescent;
        facts_ = render_facts(scene, primitives_, build_tree(scene, primitives_, profile), profile,
                              size);
    }

    /// Pixels whose lights differ from the exact profile's. `lights` = 0: the scene's.
    int wrong_pixels(InstructionSet isa) {
        ShadowTables tables(fast_, isa);
        PairShadows pairs(fast_);
        ShadowStage stage(tables, pairs, isa, true);
        int wrong = 0;
        for (int y = 0; y < size_.height; y += kTileSide)
            for (int x = 0; x < size_.width; x += kTileSide) wrong += wrong_in_tile(stage, x, y);
        return wrong;
    }

    const FastScene& fast() const { return fast_; }

  private:
    int wrong_in_tile(ShadowStage& stage, int x, int y) {
        const auto tile = std::make_unique<Tile>();
        std::vector<std::optional<Kernel::Surface>> surfaces(kTileLanes);
        fill(*tile, surfaces, x, y);
        std::vector<std::uint64_t> lit(kTileLanes, 0);
        for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
            TileMask wanted = {};
            TileMask reached = {};
            for (int lane = 0; lane < kTileLanes; ++lane)
                if (surfaces[lane] && wants(*surfaces[lane], i))
                    wanted[lane / 16] |= static_cast<std::uint16_t>(1 << lane % 16);
            stage.trace(*tile, i, wanted, fallback_, reached);
            for (int lane = 0; lane < kTileLanes; ++lane) {
                EXPECT_FALSE((reached[lane / 16] & ~wanted[lane / 16]) >> lane % 16 & 1);
                if (reached[lane / 16] >> lane % 16 & 1) lit[lane] |= std::uint64_t{1} << i;
            }
        }
        int wrong = 0;
        for (int lane = 0; lane < kTileLanes; ++lane)
            if (surfaces[lane]) wrong += lit[lane] != fact(*tile, lane).lit;
        return wrong;
    }
    bool wants(const Kernel::Surface& surface, std::size_t light) const {
        const PrimitiveSource& source = primitives_.sources[surface.primitive];
        return scene_.lights[light].scope.includes(source.object) &&
               sample_light(scene_.lights[light], surface.point).has_value();
    }
    const PixelFacts& fact(const Tile& tile, int lane) const {
        const int row = (tile.y + lane_y(lane)) * size_.width;
        return facts_[static_cast<std::size_t>(row + tile.x + lane_x(lane))];
    }
    void fill(Tile& tile, std::vector<std::optional<Kernel::Surface>>& surfaces, int x, int y) {
        std::map<PrimitiveId, Slot> slots;
        for (Slot slot = 0; slot < fast_.slot_end(); ++slot) slots[fast_.id(slot)] = slot;
        tile.x = x;
        tile.y = y;
        tile.slot = hits_;
        for (int lane = 0; lane < kTileLanes; ++lane) {
            const bool inside = x + lane_x(lane) < size_.width && y + lane_y(lane) < size_.height;
            hits_[lane] = kNoSlot;
            tile.point_error[lane] = std::numeric_limits<float>::quiet_NaN();
            for (auto& axis : tile.point) axis[lane] = std::numeric_limits<float>::quiet_NaN();
            if (!inside || !fact(tile, lane).primitive) continue;
            const PrimitiveId id = *fact(tile, lane).primitive;
            const Object& object = scene_.objects[primitives_.sources[id].object];
            if (!scene_.materials[object.material].lit) continue;
            const ExactRay ray =
                kernel_.prepare(camera_.rays.ray(x + lane_x(lane), y + lane_y(lane)));
            const auto hit = kernel_.hit_of(ray, id);
            surfaces[lane] = kernel_.surface(ray, *hit, object);
            hits_[lane] = slots[id];
            // A float point some units off, as the surface stage may make it.
            const Point3 local = fast_.frame().local(surfaces[lane]->point);
            const double error = 4 * kFloatRoundoff * (max_norm(camera_.origin) + 1);
            for (int axis = 0; axis < 3; ++axis)
                tile.point[axis][lane] =
                    static_cast<float>(local[axis] + (lane + axis) % 3 * 0.4 * error);
            tile.point_error[lane] = static_cast<float>(error);
        }
    }

    const Scene& scene_;
    Resolution size_;
    Primitives primitives_;
    FastScene fast_;
    CameraRays camera_;
    Bounds3 triangles_;
    Slot hits_[kTileLanes];  // of the tile in use
    ExactFallback fallback_;
    ExactKernelOf<SceneStore> kernel_;
    std::vector<PixelFacts> facts_;
};

void expect_exact(const Scene& scene, Resolution size, const std::string& what) {
    for (const OctreeType type : {OctreeType::kUniform, OctreeType::kNonuniform}) {
        ShadowPicture picture(scene, size, type);
        for (const InstructionSet isa : supported_instruction_sets())
            EXPECT_EQ(picture.wrong_pixels(isa), 0)
                << what << ", instruction set " << static_cast<int>(isa);
    }
}

class FastShadows : public ::testing::TestWithParam<std::string> {};

TEST_P(FastShadows, ReachThePixelsThatTheExactProfileLights) {
    const std::filesystem::path folder = std::filesystem::path(NUVO_SOURCE_DIR) / "testfiles";
    expect_exact(x3d::read_file(folder / GetParam()), {120, 68}, GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Files, FastShadows,
    ::testing::Values("trianglemesh.x3d", "both.x3d", "concentric.x3d", "clumped.x3d", "teapot.x3d",
                      "icosphere.x3d", "appendixE.x3d", "figure28.x3d",
                      "hard/camera-on-surface.x3d", "hard/coincident-surfaces.x3d",
                      "hard/contact-gaps.x3d", "hard/grazing-light.x3d",
                      "hard/light-on-surface.x3d", "hard/mirrored-and-sheared.x3d",
                      "hard/moved-by-1e6.x3d", "hard/planet-and-ants.x3d", "hard/scale-1e-15.x3d",
                      "hard/scale-1e15.x3d", "hard/slivers.x3d", "hard/terminator.x3d"),
    [](const auto& file) {
        std::string name = file.param.substr(0, file.param.size() - 4);
        for (char& c : name)
            if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
        return name;
    });

/// A light of each kind of difficulty: axis-parallel, skew, among the objects, far away, on a
/// corner, in the plane of a face.
std::vector<Light> hard_lights(std::mt19937_64& random, const Scene& scene) {
    std::vector<Light> lights(9);
    for (std::size_t i = 3; i < lights.size(); ++i) {
        lights[i].kind = Light::Kind::kPoint;
        lights[i].radius = std::numeric_limits<double>::infinity();
        lights[i].location = uniform_point(random, 9);
    }
    lights[0].direction = {0, -1, 0};
    lights[1].direction = {std::numbers::sqrt2 / 2, 0, -std::numbers::sqrt2 / 2};
    lights[2].direction = normalized(uniform_point(random, 1));
    lights[5].location = uniform_point(random, 1e4);
    lights[6].location = uniform_point(random, 1e9);
    const Shape& first = scene.objects.front().shape;
    if (const auto* mesh = std::get_if<TriangleMesh>(&first)) {
        const Triangle t = mesh->triangle(0);
        lights[7].location = t.a;
        lights[8].location = t.a + (t.b - t.a) * 8;
    }
    return lights;
}

TEST(FastShadowsOfRandomScenes, ReachThePixelsThatTheExactProfileLights) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
        std::mt19937_64 random(seed);
        Scene scene = testing::random_scene(seed, 60);
        scene.lights = hard_lights(random, scene);
        scene.camera.position = {uniform(random, -8, 8), uniform(random, -8, 8), 30};
        expect_exact(scene, {48, 48}, "seed " + std::to_string(seed));
    }
}

TEST(FastShadowsOfTheGrid, ReachThePixelsThatTheExactProfileLights) {
    std::mt19937_64 random(7);
    Scene scene = testing::grid_scene();
    scene.lights = hard_lights(random, scene);
    scene.lights[3].location = {0, 0, 0};    // inside of an octahedron
    scene.lights[4].location = {2, 2, 2.5};  // inside of a sphere
    scene.camera.position = {3, 1, 25};
    expect_exact(scene, {64, 64}, "grid");
}

/// The least of a triangle's four functions, in float.
float hidden(const ShadowPlanes& planes, const float (&p)[3]) {
    float least = std::numeric_limits<float>::infinity();
    for (const auto& n : planes.plane)
        least = std::fmin(least, n[0] * p[0] + (n[1] * p[1] + (n[2] * p[2] + n[3])));
    return least;
}

/// A point near the border of what `triangle` hides from the light, or within.
Point3 behind(std::mt19937_64& random, const Triangle& t, const Light& light) {
    const double v = uniform(random, 0, 1) < 0.5 ? 0 : uniform(random, 0, 1);
    const double w = uniform(random, 0, 1) < 0.5 ? 1 - v : uniform(random, 0, 1 - v);
    const Point3 on_it = t.a + (t.b - t.a) * v + (t.c - t.a) * w;
    const Vector3 away =
        light.kind == Light::Kind::kDirectional ? light.direction : on_it - light.location;
    const double steps = std::exp2(uniform(random, -30, 0));
    const Vector3 off = uniform_point(random, 1);
    return on_it + normalized(away) * steps + off * std::exp2(uniform(random, -40, -2));
}

TEST(ShadowPlanes, NeverContradictTheExactPredicateWhereTheyAreSure) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
        std::mt19937_64 random(seed);
        Scene scene = testing::random_scene(seed, 60);
        scene.lights = hard_lights(random, scene);
        const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
        const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
        ShadowTables tables(fast, resolved(InstructionSet::kBest));
        StageCounts counts;
        int sure[2] = {};
        for (int i = 0; i < 40000; ++i) {
            const std::size_t l = random() % scene.lights.size();
            const Light& light = scene.lights[l];
            const auto slot = static_cast<Slot>(random() % fast.triangle_end());
            const PrimitiveSource& source = fast.source(slot);
            const auto& mesh = std::get<TriangleMesh>(scene.objects[source.object].shape);
            const Triangle triangle = mesh.triangle(source.triangle);
            const Point3 point = behind(random, triangle, light);
            const Point3 local = fast.frame().local(point);
            if (max_norm(local) > 1) continue;  // the bounds are those of the scene's box
            const float p[3] = {static_cast<float>(local.x), static_cast<float>(local.y),
                                static_cast<float>(local.z)};
            // P itself is rounded.
            const float size = std::max(static_cast<float>(max_norm(local)), tables.dense());
            const float error = tables.plane_error() +
                                (kPlaneError + static_cast<float>(2 * kFloatRoundoff)) * size;
            const float depth = (tables.table(l).hides[slot / 8] >> slot % 8 & 1) != 0
                                    ? hidden(tables.table(l).planes[slot], p)
                                    : -1;
            if (std::fabs(depth) <= error) continue;
            const bool endless = light.kind == Light::Kind::kDirectional;
            const ExactRay way = endless ? ExactRay(Ray{point, -light.direction})
                                         : ExactRay::between(point, light.location);
            const double end = endless ? std::numeric_limits<double>::infinity() : 1;
            const Sides sides = scene.objects[source.object].solid ? Sides::kFront : Sides::kBoth;
            ASSERT_EQ(depth > 0, blocks(way, end, 0, triangle, counts, sides))
                << "seed " << seed << ", pair " << i << ", light " << l;
            ++sure[depth > 0 ? 1 : 0];
        }
        EXPECT_GT(sure[0], 1000);
        EXPECT_GT(sure[1], 1000);
    }
}

TEST(FastShadowsOfALightAlone, AreNoneWhereNothingCastsThem) {
    Scene scene = testing::grid_scene();
    scene.lights.resize(1);
    scene.lights[0].casts_shadow = false;
    expect_exact(scene, {32, 32}, "headlight");
}

}  // namespace
}  // namespace nuvo
