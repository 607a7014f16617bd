#include "fast/light/light_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "fast/shadow/shadow_tables.h"
#include "fast/simd/dispatch.h"
#include "nuvo/geometry/predicates.h"
#include "nuvo/geometry/shape.h"
#include "property/test_scenes.h"

namespace nuvo {
namespace {

using testing::uniform;
using testing::uniform_point;

/// Where a light's grid is asked about a point: the definition in double.
struct Place {
    double u[2];
    double depth;
    int face = 0;
};

Place place_of(const LightBuffer& buffer, const LightPoint& light, const Point3& p) {
    const Vector3 way = light.toward - p * light.weight;
    Place place;
    if (!buffer.map.inside) {
        const int k = buffer.map.axis;
        for (int i = 0; i < 2; ++i) {
            const int axis = (k + 1 + i) % 3;
            place.u[i] = p[axis] - p[k] * (way[axis] / way[k]);
        }
        place.depth = -static_cast<double>(buffer.map.sign) * p[k];
        return place;
    }
    int k = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (std::fabs(way[axis]) > std::fabs(way[k])) k = axis;
    place.depth = std::fabs(way[k]);
    place.face = 2 * k + (way[k] < 0 ? 1 : 0);
    for (int i = 0; i < 2; ++i) place.u[i] = way[(k + 1 + i) % 3] / place.depth;
    return place;
}

/// What a cell's list says of an item, read byte by byte.
struct Entry {
    Slot place;
    float near;
    std::uint32_t low[2];
    std::uint32_t high[2];
};
template <typename Use>
void for_each_entry(const LightBuffer& buffer, std::uint32_t cell, Use&& use) {
    const std::uint32_t end = buffer.starts[cell + 1];
    for (std::uint32_t i = buffer.starts[cell]; i < end; i += LightGroup::kMost) {
        const LightGroup group = buffer.group(i, end);
        ASSERT_EQ(group.count, std::min<std::uint32_t>(16, end - i));
        for (std::uint32_t k = 0; k < group.count; ++k) {
            const std::uint32_t box = group.boxes()[k];
            use(Entry{group.places()[k],
                      std::bit_cast<float>(group.nears()[k]),
                      {box & 0xff, box >> 8 & 0xff},
                      {127 - (box >> 16 & 0xff), 127 - (box >> 24)}});
        }
    }
}

/// The items that the buffer lists for the point.
std::set<Slot> listed(const LightBuffer& buffer, const Place& place) {
    std::uint32_t step[2];
    for (int i = 0; i < 2; ++i)
        step[i] = static_cast<std::uint32_t>(std::clamp(
            (place.u[i] - buffer.map.low[i]) * buffer.map.steps[i], 0.0, kLightSteps - 1.0));
    std::set<Slot> found;
    for (const LightGrid& grid : buffer.grids) {
        const auto column = step[0] * static_cast<std::uint32_t>(grid.columns) / kLightSteps;
        const auto row = step[1] * static_cast<std::uint32_t>(grid.rows) / kLightSteps +
                         static_cast<std::uint32_t>(place.face * grid.rows);
        const auto cell = grid.first_cell + row * static_cast<std::uint32_t>(grid.columns) + column;
        // The point's steps within its cell.
        const std::uint32_t at[2] = {step[0] * static_cast<std::uint32_t>(grid.columns) %
                                         kLightSteps * kCellSteps / kLightSteps,
                                     step[1] * static_cast<std::uint32_t>(grid.rows) % kLightSteps *
                                         kCellSteps / kLightSteps};
        for_each_entry(buffer, cell, [&](const Entry& entry) {
            if (entry.near <= place.depth && entry.low[0] <= at[0] && at[0] <= entry.high[0] &&
                entry.low[1] <= at[1] && at[1] <= entry.high[1])
                found.insert(entry.place);
        });
    }
    return found;
}

/// Lights around, among and far from the scene.
std::vector<Light> lights_for(std::mt19937_64& random) {
    std::vector<Light> lights(12);
    for (std::size_t i = 0; i < 4; ++i) lights[i].direction = normalized(uniform_point(random, 1));
    lights[0].direction = {0, 0, -1};
    for (std::size_t i = 4; i < lights.size(); ++i) {
        lights[i].kind = Light::Kind::kPoint;
        lights[i].radius = std::numeric_limits<double>::infinity();
        lights[i].location = uniform_point(random, i < 8 ? 9 : std::pow(10.0, i - 6));
    }
    return lights;
}

class Occlusion {
  public:
    Occlusion(const Scene& scene, const FastScene& fast) : scene_(scene), fast_(fast) {}

    bool blocks(Slot slot, const Point3& from, const Light& light) {
        const bool endless = light.kind == Light::Kind::kDirectional;
        const ExactRay way = endless ? ExactRay(Ray{from, -light.direction})
                                     : ExactRay::between(from, light.location);
        const double end = endless ? std::numeric_limits<double>::infinity() : 1;
        const PrimitiveSource& source = fast_.source(slot);
        const Object& object = scene_.objects[source.object];
        const Sides sides = object.solid ? Sides::kFront : Sides::kBoth;
        const Shape& shape = object.shape;
        if (const auto* mesh = std::get_if<TriangleMesh>(&shape))
            return nuvo::blocks(way, end, 0, mesh->triangle(source.triangle), counts_, sides);
        if (const auto* sphere = std::get_if<Sphere>(&shape))
            return nuvo::blocks(way, end, 0, *sphere, false, counts_, sides);
        return false;
    }

  private:
    const Scene& scene_;
    const FastScene& fast_;
    StageCounts counts_;
};

/// A point in the local frame, within what some item hides and often near that shadow's border.
Point3 shaded_point(std::mt19937_64& random, const Scene& scene, const FastScene& fast,
                    const Light& light) {
    const auto slot = static_cast<Slot>(random() % fast.slot_end());
    const PrimitiveSource& source = fast.source(slot);
    const Shape& shape = scene.objects[source.object].shape;
    Point3 on_it = bounds(shape).center();
    const double inwards = std::exp2(uniform(random, -30, 0));
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape)) {
        const Triangle t = mesh->triangle(source.triangle);
        on_it = t.a + (t.b - t.a) * (inwards * 0.5) + (t.c - t.a) * (inwards * 0.4);
    } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        on_it = sphere->center +
                normalized(uniform_point(random, 1)) * (sphere->radius * (1 - inwards));
    }
    const Vector3 away =
        light.kind == Light::Kind::kDirectional ? light.direction : on_it - light.location;
    return fast.frame().local(on_it + normalized(away) * std::exp2(uniform(random, -20, 3)));
}

TEST(LightBuffer, ListsEveryItemThatBlocksAPointKnownWellEnough) {
    std::map<bool, int> blocked;  // by whether the light is among the items
    for (unsigned seed = 1; seed <= 5; ++seed) {
        std::mt19937_64 random(seed);
        Scene scene = testing::random_scene(seed, 80);
        scene.lights = lights_for(random);
        const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
        const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
        Occlusion occlusion(scene, fast);
        for (const InstructionSet isa : supported_instruction_sets()) {
            ShadowTables tables(fast, isa);
            for (int i = 0; i < 1500; ++i) {
                const std::size_t l = random() % scene.lights.size();
                const LightBuffer& buffer = tables.table(l).buffer;
                if (!buffer.usable()) continue;
                const Point3 local = shaded_point(random, scene, fast, scene.lights[l]);
                if (!(max_norm(local) < 1)) continue;
                const Point3 point = local * (1 / fast.frame().scale) + fast.frame().center;
                // As far off as allowed.
                const Point3 near =
                    local + uniform_point(random, 1) * (0.999 * buffer.map.point_error);
                const Place place = place_of(buffer, tables.table(l).light, near);
                if (buffer.map.inside && place.depth < buffer.map.nearest) continue;
                const std::set<Slot> found = listed(buffer, place);
                for (Slot slot = 0; slot < fast.slot_end(); ++slot) {
                    if (!occlusion.blocks(slot, point, scene.lights[l])) continue;
                    ASSERT_TRUE(found.contains(slot)) << "seed " << seed << ", point " << i
                                                      << ", light " << l << ", slot " << slot;
                    ++blocked[buffer.map.inside];
                }
            }
        }
    }
    EXPECT_GT(blocked[false], 1000);
    EXPECT_GT(blocked[true], 1000);
}

/// 10 x 10 stacks of so many spheres, two units apart, and a light along them.
struct Stacks {
    Stacks(int of, double radius)
        : scene(scene_of(of, radius)),
          primitives(flatten(scene, LeafContent::kPrimitives)),
          fast(scene, primitives, OctreeType::kUniform, 1),
          tables(fast, resolved(InstructionSet::kBest)) {}

    Scene scene;
    Primitives primitives;
    FastScene fast;
    ShadowTables tables;

  private:
    static Scene scene_of(int of, double radius) {
        Scene scene;
        scene.materials.emplace_back();
        for (int i = 0; i < 100 * of; ++i) {
            Object object;
            object.shape = Sphere{{2.0 * (i % 10), 2.0 * (i / 10 % 10), 2.0 * (i / 100)}, radius};
            scene.objects.push_back(object);
        }
        scene.lights.resize(1);
        scene.lights[0].direction = {0, 0, -1};
        return scene;
    }
};

TEST(CellBox, MeetsWhatItOverlaps) {
    const auto meets = [](const CellBox& item, const CellBox& window) {
        return ((window.window() - item.item()) & CellBox::kMeets) == CellBox::kMeets;
    };
    std::mt19937 random(20261129);
    const auto number = [&]() -> std::uint32_t {
        constexpr std::uint32_t kEdges[] = {0, 1, 63, 64, 126, 127};
        if (random() % 2 != 0) return kEdges[random() % 6];
        return static_cast<std::uint32_t>(random() % 128);
    };
    int met = 0;
    constexpr int kPairs = 100'000;
    for (int i = 0; i < kPairs; ++i) {
        CellBox box[2];
        bool overlap = true;
        for (int k = 0; k < 2; ++k) {
            for (CellBox& one : box) {
                const std::uint32_t a = number();
                const std::uint32_t b = number();
                one.low[k] = std::min(a, b);
                one.high[k] = std::max(a, b);
            }
            overlap = overlap && box[0].low[k] <= box[1].high[k] && box[1].low[k] <= box[0].high[k];
        }
        ASSERT_EQ(meets(box[0], box[1]), overlap);
        met += overlap ? 1 : 0;
    }
    EXPECT_GT(met, kPairs / 4);
    EXPECT_LT(met, kPairs * 3 / 4);
}

// Steps of cells are told apart as finely as the cells, and keep the order of steps.
TEST(CellBox, StepsOfCellsKeepTheOrder) {
    for (const int count : {1, 3, 100, 8191, 8192}) {
        std::uint32_t last = 0;
        for (std::uint32_t step = 0; step < kLightSteps; ++step) {
            const std::uint32_t at = cell_step(step, count);
            ASSERT_GE(at, last);
            ASSERT_EQ(at / kCellSteps,
                      std::uint64_t{step} * static_cast<std::uint64_t>(count) / kLightSteps);
            last = at;
        }
    }
}

TEST(LightBuffer, LongListsBeginNearTheLight) {
    for (const int of : {5, 500}) {
        const Stacks stacks(of, 1.2);
        const LightBuffer& buffer = stacks.tables.table(0).buffer;
        ASSERT_TRUE(buffer.usable());
        EXPECT_EQ(buffer.near_first, of == 500);
        if (!buffer.near_first) continue;
        std::size_t longest = 0;
        for (std::uint32_t cell = 0; cell + 1 < buffer.starts.size(); ++cell) {
            std::vector<float> nears;
            for_each_entry(buffer, cell, [&](const Entry& entry) { nears.push_back(entry.near); });
            EXPECT_TRUE(std::is_sorted(nears.begin(), nears.end()));
            longest = std::max(longest, nears.size());
        }
        EXPECT_GE(longest, 500U);
    }
}

TEST(LightBuffer, ListsFewItemsWhereNoneIsLarge) {
    // Of radius 0.1: the light sees 100 stacks of 10.
    const Stacks stacks(10, 0.1);
    const LightPoint& light = stacks.tables.table(0).light;
    const LightBuffer& buffer = stacks.tables.table(0).buffer;
    ASSERT_TRUE(buffer.usable());
    ASSERT_FALSE(buffer.map.inside);
    // Below the lowest sphere of a stack, and between the stacks.
    const Point3 below = stacks.fast.frame().local({6, 4, -1});
    EXPECT_EQ(listed(buffer, place_of(buffer, light, below)).size(), 10U);
    const Point3 between = stacks.fast.frame().local({7, 5, -1});
    EXPECT_EQ(listed(buffer, place_of(buffer, light, between)).size(), 0U);
}

// A hilly mesh of 2 x 2 units on a ground that is far wider.
TEST(LightBuffer, ListsFewItemsOnAGroundOfAnyWidth) {
    constexpr std::uint32_t kSide = 40;
    TriangleMesh hills;
    for (std::uint32_t z = 0; z <= kSide; ++z)
        for (std::uint32_t x = 0; x <= kSide; ++x)
            hills.positions.push_back({x * (2.0 / kSide) - 1,
                                       0.1 * std::sin(7.0 * x) * std::cos(5.0 * z),
                                       z * (2.0 / kSide) - 1});
    for (std::uint32_t z = 0; z < kSide; ++z)
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const std::uint32_t at = z * (kSide + 1) + x;
            hills.triangles.push_back({at, at + kSide + 1, at + 1});
            hills.triangles.push_back({at + 1, at + kSide + 1, at + kSide + 2});
        }
    for (const double half : {1e1, 1e6, 1e9, 1e10}) {
        SCOPED_TRACE(half);
        TriangleMesh ground;
        ground.positions = {
            {-half, -1, -half}, {half, -1, -half}, {-half, -1, half}, {half, -1, half}};
        ground.triangles = {{0, 2, 1}, {1, 2, 3}};
        Scene scene;
        for (const TriangleMesh& mesh : {hills, ground}) {
            Object object;
            object.shape = mesh;
            object.shape_index = static_cast<std::uint32_t>(scene.shape_count++);
            scene.objects.push_back(object);
        }
        Light sun;
        sun.direction = normalized(Vector3{-0.3, -1, -0.4});
        scene.lights = {sun};
        const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
        const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
        const ShadowTables tables(fast, InstructionSet::kBest);
        const LightBuffer& buffer = tables.table(0).buffer;
        ASSERT_TRUE(buffer.usable());
        std::size_t longest = 0;
        for (std::uint32_t cell = 0; cell + 1 < buffer.starts.size(); ++cell) {
            std::size_t entries = 0;
            for_each_entry(buffer, cell, [&](const Entry&) { ++entries; });
            longest = std::max(longest, entries);
        }
        // At 1e10 shadow rays pass within 0.02 of what they may touch: cells are wider.
        EXPECT_LT(longest, half < 1e10 ? 200U : 2000U);
    }
}

}  // namespace
}  // namespace nuvo
