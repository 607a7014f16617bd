// Compiled once for each instruction set by foreach_target.h, as the library's kernels are.
#define HWY_DISABLED_TARGETS HWY_SSSE3

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/light_bounds_test.cpp"
#include <hwy/foreach_target.h>

#include "fast/light/light_cells.h"
#include "fast/light/light_ranges.h"

namespace nuvo {
#ifndef NUVO_TESTS_RENDER_LIGHT_BOUNDS_TEST_CPP_
#define NUVO_TESTS_RENDER_LIGHT_BOUNDS_TEST_CPP_
/// 16 items and as many points, and what is known of them.
struct RangeQuestion {
    int count;  ///< corners of an item
    float corner[3][3][16];
    float point[3][16];
    double error;
    double touch;
};
/// Where a light sees them.
struct RangeAnswers {
    bool usable = false;
    LightMap map;
    std::uint32_t lanes[6] = {};
    float low[6][2][16], high[6][2][16], near[6][16];
    float u[2][16], depth[16];
    std::int32_t face[16];
    std::uint32_t known = 0;
};
#endif
}  // namespace nuvo

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

void ask_ranges(const FastScene& scene, const LightPoint& light, const RangeQuestion& q,
                RangeAnswers& out) {
    ItemRanges ranges;
    float extent[2];
    out.usable = ranges.start(light, scene, out.map, extent);
    if (!out.usable) return;
    ranges.allow(q.error, q.touch, out.map);
    ItemCorners items;
    items.count = q.count;
    for (int i = 0; i < q.count; ++i)
        for (int axis = 0; axis < 3; ++axis) items.at[i][axis] = Floats::load(q.corner[i][axis]);
    ranges.for_each_face(items, 0xffff,
                         [&](int face, const LightRanges& r, std::uint32_t lanes) HWY_ATTR {
                             out.lanes[face] = lanes;
                             for (int i = 0; i < 2; ++i) {
                                 r.low[i].store(out.low[face][i]);
                                 r.high[i].store(out.high[face][i]);
                             }
                             r.near.store(out.near[face]);
                         });
    const Points points{Floats::load(q.point[0]), Floats::load(q.point[1]),
                        Floats::load(q.point[2])};
    const LightPlaces places(out.map, light, points, Floats(rounded_up(q.error)));
    for (int i = 0; i < 2; ++i) places.u[i].store(out.u[i]);
    places.depth.store(out.depth);
    places.face.store(out.face);
    out.known = places.known;
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <cmath>
#include <random>

#include "fast/shadow/shadow_beam.h"
#include "fast/simd/dispatch.h"
#include "fast_cases.h"

// Where lights see items and points, against doubles: corners, points and the way that a shadow
// ray takes past an item as far off as they may be.
namespace nuvo::testing {
namespace {

constexpr unsigned kSeed = 20261171;
constexpr double kFloatUnit = 0x1p-24;

/// A light around, among or far from the scene; in the local frame.
LightPoint any_light(std::mt19937_64& random, const LocalFrame& frame) {
    Light light;
    light.direction = normalized(uniform_point(random, 1));
    if (random() % 4 == 0) light.direction = {0, -1, 0};
    if (random() % 3 != 0) {
        light.kind = Light::Kind::kPoint;
        light.location =
            uniform_point(random, random() % 2 != 0 ? 6 : std::exp2(uniform(random, 3, 20)));
    }
    return LightPoint(light, frame);
}

/// From a point to the light, not normalized.
Vector3 way_to(const LightPoint& light, const Point3& p) { return light.toward - p * light.weight; }

/// u, v and the depth of a point, as light_map.h defines them.
struct Place {
    double u[2];
    double depth;

    Place(const LightMap& map, int face, const LightPoint& light, const Point3& p) {
        const Vector3 w = way_to(light, p);
        const int k = map.inside ? face / 2 : map.axis;
        depth = map.inside ? std::fabs(w[k]) : -static_cast<double>(map.sign) * p[k];
        for (int i = 0; i < 2; ++i) {
            const int axis = (k + 1 + i) % 3;
            u[i] = map.inside ? w[axis] / depth : p[axis] - p[k] * (w[axis] / w[k]);
        }
    }
};

class RangeCase {
  public:
    RangeCase(std::mt19937_64& random, const FastScene& scene) : random_(random) {
        light.emplace(any_light(random, scene.frame()));
        question.count = random() % 2 != 0 ? 3 : 2;
        question.error = std::exp2(uniform(random, -22, -13));
        question.touch = random() % 2 != 0 ? 0 : question.error * uniform(random, 0, 1);
        for (int lane = 0; lane < 16; ++lane) put(lane);
    }

    std::optional<LightPoint> light;
    RangeQuestion question;

  private:
    Vector3 signs() {
        const auto sign = [&] { return random_() % 2 != 0 ? 1.0 : -1.0; };
        return {sign(), sign(), sign()};
    }
    // An item, and behind it a point whose shadow ray passes a corner.
    void put(int lane) {
        const Point3 middle = uniform_point(random_, 0.9);
        const double half = std::exp2(uniform(random_, -12, -2));
        double size = 0;
        for (int axis = 0; axis < 3; ++axis) {
            float at[3];
            for (float& x : at)
                x = static_cast<float>(
                    std::clamp(middle[axis] + uniform(random_, -half, half), -1.0, 1.0));
            if (question.count == 2 && at[0] > at[1]) std::swap(at[0], at[1]);
            for (int i = 0; i < 3; ++i) question.corner[i][axis][lane] = at[i];
            for (int i = 0; i < question.count; ++i)
                size = std::fmax(size, std::fabs(static_cast<double>(at[i])));
        }
        Point3 passed;
        const Vector3 side = signs();
        const auto corner = random_() % static_cast<unsigned>(question.count);
        for (int axis = 0; axis < 3; ++axis) {
            // Any corner of a box.
            const auto i = question.count == 2 ? random_() % 2 : corner;
            passed[axis] = static_cast<double>(question.corner[i][axis][lane]) +
                           side[axis] * (4 * kFloatUnit * size + question.touch);
        }
        const Vector3 away =
            normalized(way_to(*light, passed)) * -std::exp2(uniform(random_, -14, 0));
        const Point3 point = passed + away;
        const Vector3 off = signs() * (question.error * (1 - 0x1p-10) - kFloatUnit);
        for (int axis = 0; axis < 3; ++axis)
            question.point[axis][lane] = static_cast<float>(point[axis] + off[axis]);
    }

    std::mt19937_64& random_;
};

TEST(LightBounds, HoldWhereItemsAreMet) {
    std::mt19937_64 random(kSeed);
    SceneMaker maker(kSeed);
    Scene scene = maker.scene();
    while (scene.objects.size() < 10) scene = maker.scene();
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const FastScene fast(scene, primitives, OctreeType::kUniform, 1);
    for (const InstructionSet isa : supported_instruction_sets()) {
        const auto ask = NUVO_FOR_ISA(isa, ask_ranges);
        int judged[2] = {};
        double share[2] = {};  // of the margin, that a place took
        double least_depth[2] = {1e9, 1e9};
        for (int round = 0; round < 12'000; ++round) {
            const RangeCase made(random, fast);
            RangeAnswers found;
            ask(fast, *made.light, made.question, found);
            if (!found.usable) continue;
            const bool inside = found.map.inside;
            for (int lane = 0; lane < 16; ++lane) {
                if ((found.known >> lane & 1) == 0) continue;
                const std::string where = "seed " + std::to_string(kSeed) + ", round " +
                                          std::to_string(round) + ", lane " + std::to_string(lane);
                const int face = found.face[lane];
                ASSERT_TRUE((found.lanes[face] >> lane & 1) != 0) << where;
                ASSERT_GE(found.depth[lane], found.near[face][lane]) << where;
                ++judged[inside];
                // What the corners as they are copied say.
                double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300}, near = 1e300;
                const int places = made.question.count == 3 ? 3 : 8;
                for (int i = 0; i < places; ++i) {
                    Point3 corner;
                    for (int axis = 0; axis < 3; ++axis)
                        corner[axis] = static_cast<double>(
                            made.question.corner[places == 3 ? i : i >> axis & 1][axis][lane]);
                    const Place place(found.map, face, *made.light, corner);
                    near = std::fmin(near, place.depth);
                    for (int k = 0; k < 2; ++k) {
                        low[k] = std::fmin(low[k], place.u[k]);
                        high[k] = std::fmax(high[k], place.u[k]);
                    }
                }
                for (int k = 0; k < 2; ++k) {
                    const float u = found.u[k][lane];
                    ASSERT_LE(found.low[face][k][lane], u) << where;
                    ASSERT_GE(found.high[face][k][lane], u) << where;
                    if (found.low[face][k][lane] == -2 || !(near > 0x1p-8 || !inside)) continue;
                    const double below = low[k] - static_cast<double>(found.low[face][k][lane]);
                    const double above = static_cast<double>(found.high[face][k][lane]) - high[k];
                    share[inside] =
                        std::fmax(share[inside], (low[k] - static_cast<double>(u)) / below);
                    share[inside] =
                        std::fmax(share[inside], (static_cast<double>(u) - high[k]) / above);
                }
                least_depth[inside] = std::fmin(
                    least_depth[inside], (near - static_cast<double>(found.near[face][lane])) /
                                             (made.question.error + made.question.touch));
            }
        }
        for (const bool inside : {false, true}) {
            EXPECT_GT(judged[inside], 20'000) << inside;
            EXPECT_GT(share[inside], inside ? 0.2 : 0.42);
            EXPECT_LT(least_depth[inside], 2.01) << inside;
        }
    }
}

// Every shadow ray from points of a box, each coordinate off by `slack`, in the beam.
TEST(LightBounds, HoldShadowRaysInTheirBeam) {
    std::mt19937_64 random(kSeed + 1);
    const LocalFrame frame{{}, 1, 0.25};
    double widest = 0;  // of the bounds, beyond what there is, in roundings
    for (int round = 0; round < 20'000; ++round) {
        const LightPoint light = any_light(random, frame);
        const float slack =
            random() % 4 == 0 ? 0 : static_cast<float>(std::exp2(uniform(random, -40, -4)));
        float low[3], high[3];
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = static_cast<float>(uniform(random, -1, 1));
            high[axis] = random() % 4 == 0
                             ? low[axis]
                             : low[axis] + static_cast<float>(std::exp2(uniform(random, -20, -2)));
        }
        const BeamBox beam = beam_to_light(light, low, high, slack);
        const bool from_light = beam.far_first;
        for (int i = 0; i < 8; ++i) {
            const std::string where =
                "seed " + std::to_string(kSeed + 1) + ", round " + std::to_string(round);
            for (int axis = 0; axis < 3; ++axis) {
                const long double p = (i >> axis & 1) != 0
                                          ? static_cast<long double>(high[axis]) + slack
                                          : static_cast<long double>(low[axis]) - slack;
                const long double from =
                    static_cast<long double>(light.toward[axis]) / light.weight;
                const bool across = light.weight == 0 && light.toward[axis] == 0;
                const long double origin = from_light ? from : p;
                const long double way =
                    from_light ? p - from
                               : light.toward[axis] - static_cast<long double>(light.weight) * p;
                ASSERT_LE(beam.origin_low[axis], origin + (from_light ? 0 : 0x1p-24L)) << where;
                ASSERT_GE(beam.origin_high[axis], origin - (from_light ? 0 : 0x1p-24L)) << where;
                if (!across) {
                    ASSERT_LE(beam.direction_low[axis], way) << where;
                    ASSERT_GE(beam.direction_high[axis], way) << where;
                }
                ASSERT_LE(std::fabs(beam.direction_low[axis]), 1e30F) << where;
                ASSERT_FALSE(beam.direction_low[axis] == 0 || beam.direction_high[axis] == 0)
                    << where;
                const long double width =
                    2 * static_cast<long double>(slack) + high[axis] - low[axis];
                const long double size = 1 + (from_light ? std::fabs(from) : 0);
                widest = std::fmax(
                    widest,
                    static_cast<double>((beam.direction_high[axis] - beam.direction_low[axis] -
                                         width * (from_light ? 1 : light.weight)) /
                                        (size * 0x1p-24L)));
                widest = std::fmax(
                    widest, static_cast<double>((beam.origin_high[axis] - beam.origin_low[axis] -
                                                 (from_light ? 0 : width)) /
                                                (size * 0x1p-24L)));
            }
            ASSERT_GE(beam.t_end, from_light ? 1 : std::fmin(0x1p60, 1 / light.weight)) << where;
        }
    }
    EXPECT_LT(widest, 12.5);
}

}  // namespace
}  // namespace nuvo::testing
#endif
