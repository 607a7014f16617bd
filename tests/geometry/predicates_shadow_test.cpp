#include <gtest/gtest.h>

#include <limits>

#include "geometry/predicates_cases.h"
#include "geometry/predicates_oracle.h"

namespace nuvo {
namespace {

using cases::Random;

constexpr std::uint64_t kSeed = 20250331;
constexpr double kEndless = std::numeric_limits<double>::infinity();

class ShadowPredicate : public ::testing::TestWithParam<cases::Placement> {};

/// Ends that a caller may ask for, and the errors of a lit point.
double some_end(Random& random) {
    constexpr double kEnds[] = {1, 1, 1, kEndless, 0.5, 2};
    return kEnds[random.below(6)];
}
double some_error(Random& random, const Point3& origin) {
    constexpr double kFactors[] = {0, 4 * kUnitRoundoff, 512 * kUnitRoundoff, 0x1p-30, 0x1p-10};
    return kFactors[random.below(5)] * max_norm(origin);
}

TEST_P(ShadowPredicate, TrianglesBlockByTheDefinition) {
    constexpr int kCases = 2400;
    Random random(kSeed, GetParam());
    StageCounts counts;
    int blocked = 0;
    for (int i = 0; i < kCases; ++i) {
        const int kind = i % cases::kTriangleKinds;
        const auto [ray, triangle] = cases::triangle_case(random, kind);
        const double end = some_end(random);
        const double error = some_error(random, ray.origin());
        SCOPED_TRACE(::testing::Message()
                     << GetParam().name << ", seed " << kSeed << ", case " << i << ", kind " << kind
                     << ", end " << end << ", error " << error);
        const bool truth = oracle::blocks(oracle::line(ray), end, error, triangle);
        ASSERT_EQ(blocks(ray, end, error, triangle, counts), truth);
        blocked += truth;
    }
    EXPECT_GT(blocked, kCases / 10);
}

template <typename Primitive>
void expect_the_truth(Random& random, const ExactRay& ray, const Primitive& primitive,
                      StageCounts& counts, int& blocked) {
    const double end = some_end(random);
    const bool on_it = random.below(8) == 0;
    const double error = some_error(random, ray.origin());
    const bool truth =
        oracle::blocks(oracle::ball(oracle::line(ray), primitive), end, error, on_it);
    EXPECT_EQ(blocks(ray, end, error, primitive, on_it, counts), truth)
        << "end " << end << ", error " << error << ", on it " << on_it;
    blocked += truth;
}

TEST_P(ShadowPredicate, SpheresAndEllipsoidsBlockByTheDefinition) {
    constexpr int kCases = 2400;
    Random random(kSeed + 1, GetParam());
    StageCounts counts;
    int blocked = 0;
    for (int i = 0; i < kCases; ++i) {
        const int kind = i % cases::kSphereKinds;
        SCOPED_TRACE(::testing::Message() << GetParam().name << ", seed " << kSeed + 1 << ", case "
                                          << i << ", kind " << kind);
        const auto [ray, sphere] = cases::sphere_case(random, kind);
        expect_the_truth(random, ray, sphere, counts, blocked);
        const auto [other, ellipsoid] = cases::ellipsoid_case(random, kind);
        expect_the_truth(random, other, ellipsoid, counts, blocked);
        if (HasFailure()) return;
    }
    EXPECT_GT(blocked, kCases / 10);
}

INSTANTIATE_TEST_SUITE_P(Placements, ShadowPredicate, ::testing::ValuesIn(cases::kPlacements));

/// Shadows from points that were hit, as a tracer asks for them.
bool in_shadow(const SurfacePoint& p, const Point3& light, const std::vector<Triangle>& others) {
    StageCounts counts;
    const ExactRay shadow = ExactRay::between(p.point, light);
    for (const Triangle& t : others)
        if (blocks(shadow, 1, p.error, t, counts)) return true;
    return false;
}

TEST(Shadow, CoincidentAndAdjacentSurfacesCastNone) {
    // A floor in a general position, its coincident copy under another triangulation, and light so
    // low that it grazes both.
    Random random(kSeed + 2, cases::kPlacements[1]);
    int tested = 0;
    for (int i = 0; i < 2000; ++i) {
        const Point3 a = random.vector();
        const Vector3 e1 = random.lattice();
        const Vector3 e2 = random.lattice();
        const Vector3 n = cross(e1, e2);
        if (max_norm(n) == 0) continue;
        const Triangle lit{a, a + e1, a + e2};
        const std::vector<Triangle> others{
            {a + e2, a + e1, a},
            {a + e1 * 0.5, a + e2, a + e1 * -1},
            {a + e1, a + e2, a + e1 + e2},
        };
        const Point3 from = a + n + random.vector() * 0.1;
        const ExactRay eye = ExactRay::between(from, a + e1 * 0.25 + e2 * random.uniform(0.1, 0.7));
        StageCounts counts;
        if (!hit(eye, lit, counts)) continue;
        const SurfacePoint p = surface_point(eye, lit);
        const double along_e1 = random.uniform(-9, 9);
        const double along_e2 = random.uniform(-9, 9);
        const Point3 light = a + e1 * along_e1 + e2 * along_e2 + n * std::exp2(-random.below(40));
        EXPECT_FALSE(in_shadow(p, light, others)) << "seed " << kSeed + 2 << ", case " << i;
        ++tested;
    }
    EXPECT_GT(tested, 1000);
}

TEST(Shadow, ContactGapsDownTo1e8AreSeen) {
    for (const double offset : {0.0, 1.0, 100.0})
        for (const double gap : {1e-1, 1e-3, 1e-5, 1e-7, 1e-8}) {
            const auto moved = [&](double x, double y, double z) {
                return Point3{x + offset, y + offset, z + offset};
            };
            const Triangle floor{moved(-5, -5, 0), moved(5, -5, 0), moved(0, 9, 0)};
            const Triangle lid{moved(-1, -1, gap), moved(1, -1, gap), moved(0, 2, gap)};
            // The eye looks up from below, so that the floor is what it meets.
            const ExactRay eye(Ray{moved(0.125, 0.25, -7), {0.01, 0.02, 1}});
            StageCounts counts;
            ASSERT_TRUE(hit(eye, floor, counts));
            const SurfacePoint p = surface_point(eye, floor);
            EXPECT_TRUE(in_shadow(p, moved(0, 0, 3), {lid})) << offset << ' ' << gap;
            EXPECT_FALSE(in_shadow(p, moved(0, 0, gap * 0.5), {lid})) << offset << ' ' << gap;
        }
}

TEST(Shadow, LightOnASurfaceIsNotBlockedByIt) {
    Random random(kSeed + 3, cases::kPlacements[1]);
    StageCounts counts;
    for (int i = 0; i < 2000; ++i) {
        // A lamp's face whose plane contains the light: a corner, or an exact midpoint.
        const Vector3 corner = random.lattice();
        const Triangle face{corner, random.lattice(), random.lattice()};
        const Point3 light = random.below(2) != 0 ? face.a : (face.b + face.c) * 0.5;
        const Point3 p = random.vector() * 5;
        EXPECT_FALSE(blocks(ExactRay::between(p, light), 1, 0, face, counts)) << "case " << i;
    }
    const Sphere lamp{{0, 0, 0}, 9 / 8.0};
    const Point3 on_it{1 / 8.0, 4 / 8.0, 1};  // 1 + 16 + 64 = 81 sixty-fourths
    EXPECT_FALSE(blocks(ExactRay::between({1, 4, 8}, on_it), 1, 0, lamp, false, counts));
    EXPECT_TRUE(blocks(ExactRay::between({-1, -4, -8}, on_it), 1, 0, lamp, false, counts));
    EXPECT_TRUE(blocks(ExactRay::between({1, 4, 8}, {0, 0, 0}), 1, 0, lamp, false, counts));
    EXPECT_FALSE(blocks(ExactRay::between({0.5, 0, 0}, {0, 0, 0.5}), 1, 0, lamp, false, counts))
        << "both inside";
}

/// A lit triangle, another that shares no corner, one or an edge with it, and a light, in the lit
/// plane in a third of all cases. What is asked of them is told by rationals.
struct LitCase {
    LitCase(Random& random, int i) {
        const auto corner = [&] { return i % 2 == 0 ? random.lattice() : random.vector(); };
        lit = {corner(), corner(), corner()};
        other = {corner(), corner(), corner()};
        if (i % 3 > 0) other.a = lit.b;
        if (i % 3 > 1) other.b = lit.a;
        light = {corner() * 4, random.below(2) == 0};
        if (random.below(3) == 0) {  // exact on the lattice
            const int along_ab = random.below(5);
            const int along_ac = random.below(5);
            light.at = (lit.b - lit.a) * along_ab + (lit.c - lit.a) * along_ac +
                       (light.endless ? Vector3{} : lit.a);
        }
        a = oracle::rational(lit.a);
        e1 = oracle::rational(lit.b) - a;
        e2 = oracle::rational(lit.c) - a;
        to = oracle::rational(light.at);
    }
    bool sound() const {
        return dot(cross(e1, e2), cross(e1, e2)) != 0 && !(light.at == Vector3{});
    }
    int side(const Point3& p) const { return dot(cross(e1, e2), oracle::rational(p) - a).sign(); }
    int side_of_light() const { return dot(cross(e1, e2), light.endless ? to : to - a).sign(); }

    Triangle lit;
    Triangle other;
    LightPlace light;
    oracle::RationalVector a, e1, e2, to;
};

TEST(Shadow, WhatStaysBehindTheLitPlaneBlocksNoTrueWay) {
    Random random(kSeed + 6, cases::kPlacements[1]);
    StageCounts counts;
    int behind = 0;
    for (int i = 0; i < 4000; ++i) {
        SCOPED_TRACE(::testing::Message() << "seed " << kSeed + 6 << ", case " << i);
        const LitCase c(random, i);
        if (!c.sound()) continue;
        bool stays = c.side_of_light() != 0;
        for (const Point3& p : {c.other.a, c.other.b, c.other.c})
            stays = stays && c.side_of_light() * c.side(p) <= 0;
        ASSERT_EQ(stays_behind(c.other, c.lit, c.light, counts), stays);
        if (!stays) continue;
        ++behind;
        for (int k = 0; k < 8; ++k) {
            const oracle::Rational u(random.below(64), 128);
            const oracle::Rational v(random.below(64), 128);
            const oracle::RationalVector point = c.a + c.e1 * u + c.e2 * v;
            const oracle::ExactLine way{point, c.light.endless ? c.to : c.to - point};
            const auto met = oracle::plane_hit(way, c.other);
            EXPECT_FALSE(met && met->inside() && met->t > 0 && (c.light.endless || met->t < 1));
        }
    }
    EXPECT_GT(behind, 500);
}

// Rounded points near the lit plane, and lights in it or up to 1e-16 beside it.
TEST(Shadow, WaysAlongTheLitPlaneStartOnTheLightsSide) {
    Random random(kSeed + 7, cases::kPlacements[1]);
    StageCounts counts;
    int moved = 0;
    int two = 0;
    for (int i = 0; i < 4000; ++i) {
        SCOPED_TRACE(::testing::Message() << "seed " << kSeed + 7 << ", case " << i);
        LitCase c(random, i);
        if (!c.sound()) continue;
        if (random.below(2) == 0)
            c.light.at.x += random.uniform(-1, 1) * 0x1p-52 * max_norm(c.light.at);
        c.to = oracle::rational(c.light.at);
        const double along_ab = random.uniform(0.1, 0.5);
        const double along_ac = random.uniform(0.1, 0.5);
        const Point3 p = c.lit.a + (c.lit.b - c.lit.a) * along_ab + (c.lit.c - c.lit.a) * along_ac;
        const WayStart rounded{p, 16 * kUnitRoundoff * (max_norm(p) + 1)};
        const WayStarts starts = way_starts(rounded, c.lit, c.light, counts);
        const int side = c.side(p);
        const bool stays = starts.first.point == p;
        if (stays) {
            EXPECT_EQ(starts.first.error, rounded.error);
        } else {
            EXPECT_EQ(side, -c.side_of_light());
            EXPECT_EQ(c.side(starts.first.point), c.side_of_light());
            ++moved;
        }
        if (starts.second) {
            EXPECT_TRUE(stays);
            EXPECT_EQ(c.side_of_light(), 0);
            EXPECT_EQ(c.side(starts.second->point), -side);
            ++two;
        }
        for (const WayStart& start : {starts.first, starts.second.value_or(starts.first)})
            EXPECT_LE(max_norm(start.point - p) + rounded.error, start.error);
        EXPECT_EQ(starts.second.has_value(), c.side_of_light() == 0 && side != 0);
    }
    EXPECT_GT(moved, 100);
    EXPECT_GT(two, 300);
}

TEST(Shadow, TheTerminatorSplitsASphere) {
    // A hit sphere blocks its own light exactly on the far side of the terminator.
    Random random(kSeed + 4, cases::kPlacements[1]);
    StageCounts counts;
    int decided = 0;
    for (int i = 0; i < 4000; ++i) {
        const Sphere s{random.vector(), random.uniform(0.1, 2)};
        const Point3 from = random.vector() * 9;
        const ExactRay eye = ExactRay::between(from, s.center + random.vector() * s.radius);
        const std::optional<SphereHit> found = hit(eye, s, counts);
        if (!found) continue;
        const SurfacePoint p = surface_point(eye, s, found->which);
        const Vector3 side = normalized(cross(p.normal, random.vector()));
        const double part = random.uniform(-1, 1);
        const double height = part * std::exp2(-random.below(44));
        const Vector3 to_light = side + p.normal * height;
        const bool blocked =
            blocks(ExactRay(Ray{p.point, to_light}), kEndless, p.error, s, true, counts);
        // Nearer to the terminator than the rounding of the point, either is right.
        if (std::fabs(height) < 4 * p.error / s.radius) continue;
        ASSERT_EQ(blocked, height < 0) << "seed " << kSeed + 4 << ", case " << i;
        ++decided;
    }
    EXPECT_GT(decided, 1000);
}

}  // namespace
}  // namespace nuvo
