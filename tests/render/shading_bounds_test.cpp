#include <cmath>
#include <memory>

#include "exact_kernel.h"
#include "fast/primary/primary.h"
#include "fast/shading/shading.h"
#include "fast/simd/dispatch.h"
#include "fast_cases.h"
#include "nuvo/render/shading.h"

// What the stages of shading say of points, normals and light, each with its error, against the
// serial tracer's doubles. Beside the errors that come about, all that the stages may be told is
// tried: points and normals as far off as they are said to be.
namespace nuvo::testing {
namespace {

constexpr Resolution kPicture{40, 36};
constexpr unsigned kSeed = 20261141;

/// Of what a bound allows, the most that an error took.
struct Attained {
    double share = 0;
    int judged = 0;
    int told = 0;  ///< well enough for most bytes

    /// `slack`: what the doubles themselves may be off.
    void judge(double error, double bound, double slack, const std::string& where) {
        ++judged;
        if (bound < 0x1p-18) ++told;
        ASSERT_LE(error, bound + slack) << where;
        if (bound > 0) share = std::fmax(share, error / bound);
    }
};

double off(const float (&found)[3][kTileLanes], int lane, const Vector3& truth) {
    Vector3 difference;
    for (int axis = 0; axis < 3; ++axis)
        difference[axis] = static_cast<double>(found[axis][lane]) - truth[axis];
    return length(difference);
}

/// A picture's tiles as primary rays leave them, and what the doubles say of a lane.
class Shown {
  public:
    using Kernel = ExactKernelOf<SceneStore>;

    Shown(const Scene& scene, InstructionSet isa)
        : scene_(scene),
          primitives_(flatten(scene, LeafContent::kPrimitives)),
          fast_(scene, primitives_, OctreeType::kUniform, 1),
          camera_(scene.camera, kPicture, fast_.frame()),
          fallback_(fast_, camera_),
          spheres_(fast_, camera_, isa),
          kernel_(scene, primitives_, std::nullopt),
          tables(fast_, camera_, spheres_, resolved(isa)),
          isa_(isa) {
        tables.fill_all(1);
        pick_surface_kernel(resolved(isa), kernels);
        pick_light_kernels(resolved(isa), kernels);
        pick_finish_kernel(resolved(isa), kernels);
    }

    template <typename Use>
    void for_each_tile(Use&& use) {
        PrimaryJob job{fast_, camera_, spheres_, fallback_, true, {}};
        const PrimaryStage primary(isa_);
        const auto macro = std::make_unique<MacroTile>();
        const auto quadrics = std::make_unique<EllipsoidNormals>();
        const auto tile = std::make_unique<Tile>();
        primary.trace(job, *macro, quadrics.get());
        for (int i = 0; i < MacroTile::kTiles; ++i) {
            macro->show(i, quadrics.get(), *tile);
            if (tile->x < kPicture.width && tile->y < kPicture.height) use(*tile);
        }
    }
    Ray ray(const Tile& tile, int lane) const {
        return camera_.rays.ray(tile.x + lane_x(lane), tile.y + lane_y(lane));
    }
    Kernel::Surface surface(const Tile& tile, int lane) const {
        const auto prepared = kernel_.prepare(ray(tile, lane));
        const auto hit = *kernel_.hit_of(prepared, fast_.id(tile.slot[lane]));
        return kernel_.surface(prepared, hit, object(tile, lane));
    }
    const Object& object(const Tile& tile, int lane) const {
        return scene_.objects[object_index(tile, lane)];
    }
    std::uint32_t object_index(const Tile& tile, int lane) const {
        return fast_.source(tile.slot[lane]).object;
    }
    /// q of a point that the camera sees.
    double near_at(const Point3& p) const {
        const double depth = dot(fast_.frame().local(p) - camera_.origin, camera_.forward);
        return camera_.parallel ? -depth : 1 / depth;  // the view's part of rays is 1
    }
    Vector3 local(const Point3& p) const { return fast_.frame().local(p) - Point3{}; }

  private:
    const Scene& scene_;
    Primitives primitives_;
    FastScene fast_;
    CameraRays camera_;
    ExactFallback fallback_;
    CameraTables spheres_;
    Kernel kernel_;

  public:
    ShadingTables tables;
    ShadingKernels kernels{};

  private:
    InstructionSet isa_;
};

enum Kind { kSun, kLamp, kFadingLamp, kSpot, kKinds };
constexpr const char* kNames[] = {"sun", "lamp", "fading lamp", "spot"};

class Judge {
  public:
    /// `slack`: what the doubles' depths may be off, relatively.
    explicit Judge(unsigned seed, double slack = 0x1p-40) : random_(seed), slack_(slack) {}

    /// `moved` is how far points and normals are moved within errors that say so; negative: as they
    /// come about.
    void judge(const Scene& scene, InstructionSet isa, double moved) {
        Shown shown(scene, isa);
        const auto scratch = std::make_unique<ShadingScratch>();
        moved_ = moved;
        shown.for_each_tile([&](Tile& tile) {
            shown.kernels.surface(shown.tables, tile, *scratch);
            judge_surfaces(shown, tile, *scratch);
            TileMask wanted;
            for (std::size_t light = 0; light < scene.lights.size(); ++light) {
                shown.kernels.sample(shown.tables, tile, light, *scratch, wanted);
                for (int lane = 0; lane < kTileLanes; ++lane)
                    if (is_told(tile, *scratch, lane))
                        judge_light(shown, tile, *scratch, light, wanted, lane);
            }
        });
    }

    Attained point, curved_point, flat_normal, curved_normal, smooth_normal;
    Attained shine[kKinds], lobe[kKinds];

  private:
    static bool bit(const TileMask& mask, int lane) {
        return (mask[lane / kBlockLanes] >> lane % kBlockLanes & 1) != 0;
    }
    // Lit, in the picture and not left to the fallback.
    static bool is_told(const Tile& tile, const ShadingScratch& scratch, int lane) {
        return bit(tile.inside, lane) && bit(tile.hit, lane) && bit(scratch.lit_material, lane) &&
               std::isfinite(scratch.diffuse_error[lane]);
    }

    void judge_surfaces(const Shown& shown, Tile& tile, ShadingScratch& scratch) {
        for (int lane = 0; lane < kTileLanes; ++lane) {
            if (!is_told(tile, scratch, lane)) continue;
            const auto truth = shown.surface(tile, lane);
            const double q = shown.near_at(truth.point);
            const double slack = slack_ * std::fabs(q);
            ASSERT_LE(static_cast<double>(tile.near_low[lane]), q + slack);
            ASSERT_GE(static_cast<double>(tile.near_high[lane]), q - slack);
            const bool curved =
                !std::holds_alternative<TriangleMesh>(shown.object(tile, lane).shape);
            const bool by_normal = bit(scratch.smooth, lane);
            const double error = static_cast<double>(tile.point_error[lane]);
            if (std::isfinite(error))
                (std::holds_alternative<Sphere>(shown.object(tile, lane).shape) ? curved_point
                                                                                : point)
                    .judge(off(tile.point, lane, shown.local(truth.point)), error, 0, "point");
            if (by_normal || !shown.tables.triangles.normals.empty()) {
                const double allowed =
                    by_normal ? static_cast<double>(scratch.normal_error[lane]) : 1.1 * 0x1p-24;
                if (std::isfinite(tile.normal[0][lane]))
                    (curved      ? curved_normal
                     : by_normal ? smooth_normal
                                 : flat_normal)
                        .judge(off(tile.normal, lane, truth.normal), allowed, 0x1p-34, "normal");
            }
            if (moved_ >= 0) move(tile, scratch, lane, by_normal, truth, shown.local(truth.point));
        }
    }
    // Off by `moved_` and a rounding from the truth, and said to be.
    void move(Tile& tile, ShadingScratch& scratch, int lane, bool by_normal,
              const Shown::Kernel::Surface& truth, const Vector3& place) {
        const auto shift = [&](float(&at)[3][kTileLanes], float& error, const Vector3& there) {
            const Vector3 way = normalized(uniform_point(random_, 1)) * moved_;
            for (int axis = 0; axis < 3; ++axis)
                at[axis][lane] = static_cast<float>(there[axis] + way[axis]);
            error = rounded_up(off(at, lane, there));
        };
        if (std::isfinite(tile.point_error[lane])) shift(tile.point, tile.point_error[lane], place);
        if (by_normal) shift(tile.normal, scratch.normal_error[lane], truth.normal);
    }

    void judge_light(const Shown& shown, const Tile& tile, const ShadingScratch& scratch,
                     std::size_t index, const TileMask& wanted, int lane) {
        const Scene& scene = shown.tables.scene.scene();
        const Light& light = scene.lights[index];
        const auto truth = shown.surface(tile, lane);
        const Material& material = scene.materials[shown.object(tile, lane).material];
        double shine_there = 0;
        double lobe_there = 0;
        if (light.scope.includes(shown.object_index(tile, lane)))
            if (const auto sample = sample_light(light, truth.point)) {
                const Color& c = light.color;
                const double gray = c.x == c.y && c.y == c.z ? c.x : 1;
                const Vector3 to_viewer = -shown.ray(tile, lane).direction;
                Material white;
                white.diffuse_color = white.specular_color = {1, 1, 1};
                white.ambient_intensity = material.ambient_intensity;
                white.shininess = material.shininess;
                const LightTerms terms =
                    light_terms(light, *sample, white, truth.normal, to_viewer);
                shine_there = (terms.ambient.x + terms.diffuse.x) * gray * sample->strength;
                if (material.specular_color != Color{})
                    lobe_there = terms.specular.x * gray * sample->strength;
            }
        const Kind kind = light.kind == Light::Kind::kDirectional ? kSun
                          : light.kind == Light::Kind::kSpot      ? kSpot
                          : shown.tables.lights[index].attenuated ? kFadingLamp
                                                                  : kLamp;
        if (!bit(wanted, lane)) {
            EXPECT_EQ(shine_there, 0) << kNames[kind];
            EXPECT_EQ(lobe_there, 0) << kNames[kind];
            return;
        }
        const auto judge = [&](float value, float error, double there, Attained& attained) {
            if (std::isfinite(error) && std::isfinite(value))
                attained.judge(std::fabs(static_cast<double>(value) - there),
                               static_cast<double>(error), 0x1p-40 * (1 + there),
                               std::string(kNames[kind]) + " moved " + std::to_string(moved_));
        };
        judge(scratch.shine[lane], scratch.shine_error[lane], shine_there, shine[kind]);
        if ((shown.tables.any_flags & kSpecularFlag) != 0 && material.specular_color != Color{})
            judge(scratch.lobe[lane], scratch.lobe_error[lane], lobe_there, lobe[kind]);
    }

    std::mt19937_64 random_;
    double slack_;
    double moved_ = 0;
};

// Gray lights have no roundings of their colors to allow for.
Scene scene_of(SceneMaker& maker, int round) {
    Scene scene = maker.scene();
    if (round % 3 != 0)
        for (Light& light : scene.lights) light.color = {1, 1, 1};
    for (Material& material : scene.materials) material.lit = true;
    if (round % 4 == 0)
        for (Material& material : scene.materials) material.ambient_intensity = 0;
    return scene;
}

TEST(ShadingBounds, HoldPointsNormalsAndLight) {
    for (const InstructionSet isa : supported_instruction_sets()) {
        SceneMaker maker(kSeed);
        Judge judge(kSeed + 1);
        Judge known(kSeed + 2);
        Judge moving(kSeed + 3);
        for (int round = 0; round < 1500; ++round) {
            SCOPED_TRACE("seed " + std::to_string(kSeed) + ", round " + std::to_string(round));
            const Scene scene = scene_of(maker, round);
            judge.judge(scene, isa, -1);
            known.judge(scene, isa, 0);
            moving.judge(scene, isa, round % 2 != 0 ? 0x1p-18 : 0x1p-11);
            if (::testing::Test::HasFailure()) return;
        }
        const auto expect = [](const Attained& attained, double share, const std::string& what) {
            EXPECT_GT(attained.judged, 2500) << what;
            EXPECT_GT(attained.share, share) << what;
        };
        expect(judge.point, 0.18, "points of triangles and ellipsoids");
        expect(judge.curved_point, 0.36, "points of spheres");
        expect(judge.flat_normal, 0.55, "normals of flat triangles");
        expect(judge.curved_normal, 0.22, "normals of quadrics");
        expect(judge.smooth_normal, 0.15, "normals between corners");
        // The light's own roundings, and errors of the points.
        constexpr double kShine[] = {0.75, 0.3, 0.11, 0.17}, kMovedShine[] = {0.99, 0.85, 0.7, 0.9};
        constexpr double kLobe[] = {0.22, 0.2, 0.1, 0.07}, kMovedLobe[] = {0.85, 0.7, 0.6, 0.7};
        for (int kind = 0; kind < kKinds; ++kind) {
            const std::string name = kNames[kind];
            expect(known.shine[kind], kShine[kind], name);
            expect(known.lobe[kind], kLobe[kind], name + "'s lobe");
            expect(moving.shine[kind], kMovedShine[kind], name + " seen from elsewhere");
            expect(moving.lobe[kind], kMovedLobe[kind], name + "'s lobe seen from elsewhere");
        }
    }
}

// A ground far wider than all that stands on it, lamps among that.
TEST(ShadingBounds, HoldLampsOnAWideGround) {
    SceneMaker maker(kSeed + 4);
    std::mt19937_64 random(kSeed + 5);
    Judge judge(kSeed + 6, 1);  // its corners round the points
    for (int round = 0; round < 600; ++round) {
        SCOPED_TRACE("seed " + std::to_string(kSeed + 4) + ", round " + std::to_string(round));
        Scene scene = scene_of(maker, round);
        const Vector3 x = normalized(uniform_point(random, 1));
        const Vector3 y =
            normalized(cross(x, uniform_point(random, 1))) * std::exp2(-uniform(random, 0, 8)) + x;
        const double half = std::exp2(uniform(random, 14, 26));
        const Point3 middle = uniform_point(random, 4);
        TriangleMesh ground;
        for (const int corner : {0, 1, 2, 3})
            ground.positions.push_back(middle + x * ((corner & 1) != 0 ? half : -half) +
                                       y * ((corner & 2) != 0 ? half : -half));
        ground.triangles = {{0, 1, 3}, {0, 3, 2}};
        Object object;
        object.shape = ground;
        object.shape_index = static_cast<std::uint32_t>(scene.shape_count++);
        object.solid = false;
        scene.objects.push_back(object);
        for (Light& light : scene.lights) light.scope = {};
        judge.judge(scene, supported_instruction_sets().front(), 0);
        if (HasFailure()) return;
    }
    EXPECT_GT(judge.shine[kLamp].judged, 20'000);
    EXPECT_GT(judge.shine[kLamp].share, 0.2);
    EXPECT_GT(judge.shine[kLamp].told, judge.shine[kLamp].judged / 2);
}

}  // namespace
}  // namespace nuvo::testing
