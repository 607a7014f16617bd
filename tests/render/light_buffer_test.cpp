#include "fast/light/light_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
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
        for (std::uint32_t i = buffer.starts[cell]; i < buffer.starts[cell + 1]; ++i) {
            const LightEntry& entry = buffer.entries[i];
            if (entry.near <= place.depth && entry.low[0] <= step[0] && step[0] <= entry.high[0] &&
                entry.low[1] <= step[1] && step[1] <= entry.high[1])
                found.insert(entry.place);
        }
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
            fill_tables(fast, 1, tables);
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
          tables(fast, resolved(InstructionSet::kBest)) {
        fill_tables(fast, 1, tables);
    }

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

TEST(LightBuffer, LongListsBeginNearTheLight) {
    for (const int of : {5, 500}) {
        const Stacks stacks(of, 1.2);
        const LightBuffer& buffer = stacks.tables.table(0).buffer;
        ASSERT_TRUE(buffer.usable());
        EXPECT_EQ(buffer.near_first, of == 500);
        if (!buffer.near_first) continue;
        std::size_t longest = 0;
        for (std::size_t cell = 0; cell + 2 < buffer.starts.size(); ++cell) {
            const auto first = buffer.entries.begin() + buffer.starts[cell];
            const auto last = buffer.entries.begin() + buffer.starts[cell + 1];
            EXPECT_TRUE(std::is_sorted(first, last, [](const LightEntry& a, const LightEntry& b) {
                return a.near < b.near;
            }));
            longest = std::max(longest, static_cast<std::size_t>(last - first));
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

}  // namespace
}  // namespace nuvo
