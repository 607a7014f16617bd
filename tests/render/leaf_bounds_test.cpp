// Compiled once for each instruction set by foreach_target.h, as the library's kernels are.
#define HWY_DISABLED_TARGETS HWY_SSSE3

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/leaf_bounds_test.cpp"
#include <hwy/foreach_target.h>

#include "fast/rays/ray_state.h"
#include "fast/rays/single_ray_leaf.h"

namespace nuvo {
#ifndef NUVO_TESTS_RENDER_LEAF_BOUNDS_TEST_CPP_
#define NUVO_TESTS_RENDER_LEAF_BOUNDS_TEST_CPP_
struct LeafAnswers {
    std::uint32_t sure, open;
    float low[kLeafLanes], high[kLeafLanes];
};
struct LeafQuestion {
    const RayLanes& rays;
    WideLeafHead head;
    float entry;
    std::uint32_t front;
};
#endif
}  // namespace nuvo

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

using LeafMask = LaneMask<float, kLeafLanes>;

void put(const LeafHits<kLeafLanes>& hits, LeafAnswers& out) {
    out.sure = hits.sure.bits();
    out.open = hits.open.bits();
    hits.low.store(out.low);
    hits.high.store(out.high);
}
void ask_triangles(const LeafQuestion& q, const std::uint16_t* corners, LeafAnswers& out) {
    const RayAtLeaf ray(q.rays, 0, q.head, q.entry);
    put(test_triangles<kLeafLanes>(ray, corners, kLeafLanes, LeafMask::from_bits(q.front)), out);
}
void ask_spheres(const LeafQuestion& q, const float* values, LeafAnswers& out) {
    const RayAtLeaf ray(q.rays, 0, q.head, q.entry);
    put(test_spheres<kLeafLanes>(ray, values, kLeafLanes, kLeafLanes, LeafMask::from_bits(q.front)),
        out);
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <cmath>

#include "fast/simd/dispatch.h"
#include "fast_cases.h"
#include "real_numbers.h"

// Single rays in leaves against 60 digits: corners, centers and the ray as far off as
// they are said to be, to the side where that does most.
namespace nuvo::testing {
namespace {

constexpr unsigned kSeed = 20261151;

double sign_of(double x) { return x < 0 ? -1 : 1; }
Vector3 signs_of(const Vector3& v) { return {sign_of(v.x), sign_of(v.y), sign_of(v.z)}; }

/// A leaf's grid and a ray that starts on it.
struct GridRay {
    static constexpr double kSide = 65535;   // units
    static constexpr double kAway = 0x1p14;  // units, from the grid
    static constexpr double kCorner = 0.5 + 0x1p-10;
    static constexpr double kPointError = 0x1p-6;  // units

    WideLeafHead head{};
    double unit[3];
    RayLanes lanes{};
    float entry = 0;

    explicit GridRay(std::mt19937_64& random) {
        const int exponent = -16 - static_cast<int>(random() % 6);
        for (int axis = 0; axis < 3; ++axis) {
            head.exponent[axis] =
                static_cast<std::int8_t>(exponent - static_cast<int>(random() % 3));
            unit[axis] = std::exp2(head.exponent[axis]);
            head.base[axis] = static_cast<float>(uniform(random, -1, 0.5));
        }
        entry = random() % 2 != 0 ? 0 : static_cast<float>(uniform(random, 0, 2));
    }
    /// Where the ray is at its entry, and its direction, in units of the grid.
    void aim(const Vector3& at, const Vector3& way) {
        Vector3 d{way.x * unit[0], way.y * unit[1], way.z * unit[2]};
        d = d * (1.5 / max_norm(d));
        float square = 0;
        for (int axis = 0; axis < 3; ++axis) {
            lanes.step[0][axis] = d[axis];
            lanes.direction[0][axis] = static_cast<float>(d[axis]);
            square = std::fma(lanes.direction[0][axis], lanes.direction[0][axis], square);
            lanes.origin[0][axis] = static_cast<double>(head.base[axis]) + at[axis] * unit[axis] -
                                    static_cast<double>(entry) * d[axis];
        }
        lanes.inverse[0][3] = 0;  // the origin's parameter
        lanes.near_add[0][3] = square;
        lanes.far_add[0][3] =
            static_cast<float>(kPointError * std::min({unit[0], unit[1], unit[2]}));
    }
    /// The true ray: off by its error, to the side of `side`.
    RealVector origin(const Vector3& side) const {
        RealVector out;
        for (int axis = 0; axis < 3; ++axis)
            out[axis] = (Real(lanes.origin[0][axis]) - Real(head.base[axis]) +
                         Real(lanes.far_add[0][3]) * side[axis]) /
                        Real(unit[axis]);
        return out;
    }
    RealVector direction() const {
        RealVector out;
        for (int axis = 0; axis < 3; ++axis)
            out[axis] = Real(lanes.step[0][axis]) / Real(unit[axis]);
        return out;
    }
};

Real determinant(const RealVector& a, const RealVector& b, const RealVector& c) {
    return dot(a, cross(b, c));
}

/// A triangle whose edge a, b the ray meets, and how it is copied.
struct EdgeCase {
    Vector3 copied[3];
    RealVector corner[3];  // true ones
    Vector3 side;          // to which the ray is off

    EdgeCase(std::mt19937_64& random, GridRay& ray, double sense) {
        const double width = std::exp2(uniform(random, 2, 16));
        const auto number = [&] {
            const double far = random() % 2 != 0 ? GridRay::kSide : uniform(random, 0, 65535);
            return std::floor(std::clamp(far + uniform(random, -width, width), 0.0, 65535.0));
        };
        for (Vector3& c : copied) c = {number(), number(), number()};
        const double part = uniform(random, 0.05, 0.95);
        const Vector3 met = copied[0] * (1 - part) + copied[1] * part;
        Vector3 at{place(random), place(random), place(random)};
        if (random() % 3 == 0)
            for (int axis = 1; axis < 3; ++axis) at[axis] = met[axis];
        const Vector3 way = met - at;
        // Moving a changes d . (a x b) by (b x d) times that, b by (d x a).
        const Vector3 by_a = cross(copied[1] - at, way), by_b = cross(way, copied[0] - at);
        const Vector3 move[3] = {signs_of(by_a) * (sense * GridRay::kCorner),
                                 signs_of(by_b) * (sense * GridRay::kCorner), Vector3{}};
        side = signs_of(by_a + by_b) * -sense;
        for (int i = 0; i < 3; ++i) corner[i] = RealVector(copied[i]) + RealVector(move[i]);
        // Brought back to the true edge, but for a little to either side.
        ray.aim(at, way);
        const RealVector o = ray.origin(side), d = ray.direction();
        const RealVector g(normalized(cross(copied[1] - copied[0], way)));
        const Real by_shift = determinant(d, g, corner[1] - o) + determinant(d, corner[0] - o, g);
        const Real little = 1 + uniform(random, -1e-9, 1e-9);
        const Real shift = determinant(d, corner[0] - o, corner[1] - o) / by_shift * little;
        if (!(abs(shift) < 100)) return;
        ray.aim(at + Vector3{static_cast<double>(Real(g.x * shift)),
                             static_cast<double>(Real(g.y * shift)),
                             static_cast<double>(Real(g.z * shift))},
                way);
        usable = true;
    }
    static double place(std::mt19937_64& random) {
        return random() % 2 != 0 ? -GridRay::kAway
                                 : uniform(random, -GridRay::kAway, 65535 + GridRay::kAway);
    }
    bool usable = false;
};

void put_corner(const Vector3 (&corners)[3], std::size_t lane, std::uint16_t* out) {
    for (std::size_t i = 0; i < 3; ++i)
        for (int axis = 0; axis < 3; ++axis)
            out[(3 * i + static_cast<std::size_t>(axis)) * kLeafLanes + lane] =
                static_cast<std::uint16_t>(corners[i][axis]);
}

TEST(LeafBounds, HoldAtTheEdgesOfTriangles) {
    for (const InstructionSet isa : supported_instruction_sets()) {
        const auto ask = NUVO_FOR_ISA(isa, ask_triangles);
        std::mt19937_64 random(kSeed);
        int judged = 0;
        for (int round = 0; round < 20'000; ++round) {
            GridRay ray(random);
            const EdgeCase edge(random, ray, round % 2 != 0 ? 1 : -1);
            if (!edge.usable) continue;
            std::uint16_t corners[9 * kLeafLanes] = {};
            put_corner(edge.copied, 0, corners);
            const RealVector o = ray.origin(edge.side), d = ray.direction();
            const RealVector a = edge.corner[0] - o, b = edge.corner[1] - o, c = edge.corner[2] - o;
            const Real u = determinant(d, c, b), v = determinant(d, a, c), w = determinant(d, b, a);
            const bool front = round % 4 < 2;
            const bool inside = (u > 0 && v > 0 && w > 0) || (!front && u < 0 && v < 0 && w < 0);
            LeafAnswers found;
            ask({ray.lanes, ray.head, ray.entry, front ? 1U : 0U}, corners, found);
            ++judged;
            if (inside)
                ASSERT_TRUE(((found.sure | found.open) & 1) != 0)
                    << "seed " << kSeed << ", round " << round;
            else
                ASSERT_FALSE((found.sure & 1) != 0) << "seed " << kSeed << ", round " << round;
        }
        EXPECT_GT(judged, 10'000);
    }
}

// The plane moved along the ray by all that corners and the ray may be off.
TEST(LeafBounds, HoldTheDepthOfTriangles) {
    for (const InstructionSet isa : supported_instruction_sets()) {
        const auto ask = NUVO_FOR_ISA(isa, ask_triangles);
        std::mt19937_64 random(kSeed + 1);
        int judged = 0, sure = 0, narrow = 0;
        double share = 0;
        for (int round = 0; round < 8'000; ++round) {
            GridRay ray(random);
            const double width = std::exp2(uniform(random, 3, 16));
            const Vector3 middle{uniform(random, 0, 65535), uniform(random, 0, 65535),
                                 uniform(random, 0, 65535)};
            Vector3 copied[3];
            for (Vector3& corner : copied)
                for (int axis = 0; axis < 3; ++axis)
                    corner[axis] = std::floor(
                        std::clamp(middle[axis] + uniform(random, -width, width), 0.0, 65535.0));
            const Vector3 met = copied[0] * 0.3 + copied[1] * 0.4 + copied[2] * 0.3;
            Vector3 at{EdgeCase::place(random), EdgeCase::place(random), EdgeCase::place(random)};
            if (round % 2 != 0) at = met + uniform_point(random, 1) * (2 * width);
            ray.aim(at, met - at);
            const Vector3 n = cross(copied[1] - copied[0], copied[2] - copied[0]);
            const Vector3 side = signs_of(n) * (round % 4 < 2 ? 1.0 : -1.0);
            const RealVector o = ray.origin(-side), d = ray.direction();
            const RealVector move(side * GridRay::kCorner);
            const RealVector a = RealVector(copied[0]) + move, b = RealVector(copied[1]) + move,
                             c = RealVector(copied[2]) + move;
            const RealVector normal = cross(b - a, c - a);
            if (dot(normal, d) == 0) continue;
            const Real s = dot(normal, a - o) / dot(normal, d);
            std::uint16_t corners[9 * kLeafLanes] = {};
            put_corner(copied, 0, corners);
            LeafAnswers found;
            ask({ray.lanes, ray.head, ray.entry, 0}, corners, found);
            if (((found.sure | found.open) & 1) == 0) continue;  // beside it
            ++judged;
            sure += (found.sure & 1) != 0;
            ASSERT_LE(Real(found.low[0]), s) << "seed " << kSeed + 1 << ", round " << round;
            ASSERT_GE(Real(found.high[0]), s) << "seed " << kSeed + 1 << ", round " << round;
            if (!std::isfinite(found.high[0])) continue;
            narrow += found.high[0] - found.low[0] < 0x1p-8F * found.high[0];
            const Real at_middle = (Real(found.low[0]) + Real(found.high[0])) / 2;
            attain(share, abs(s - at_middle), (Real(found.high[0]) - Real(found.low[0])) / 2);
        }
        EXPECT_GT(judged, 4000);
        EXPECT_GT(sure, 3200);
        EXPECT_GT(narrow, 2000);
        EXPECT_GT(share, 0.11);
    }
}

TEST(LeafBounds, HoldTheHitsOfSpheres) {
    for (const InstructionSet isa : supported_instruction_sets()) {
        const auto ask = NUVO_FOR_ISA(isa, ask_spheres);
        std::mt19937_64 random(kSeed + 2);
        int sure = 0, missed = 0, open = 0, narrow = 0;
        double share = 0;
        for (int round = 0; round < 20'000; ++round) {
            const Point3 center = uniform_point(random, 1);
            const float radius = static_cast<float>(std::exp2(uniform(random, -14, -1)));
            GridRay ray(random);
            // Tangent, or nearly, or anywhere; from outside, within or just before.
            const Vector3 way = normalized(uniform_point(random, 1));
            const Vector3 across = normalized(cross(way, uniform_point(random, 1)));
            const double close = std::exp2(uniform(random, -30, -1)) * (round % 2 != 0 ? 1 : -1);
            const double from_axis =
                radius * (round % 3 == 0 ? uniform(random, 0, 1.2) : 1 + close);
            const double back =
                round % 5 == 0 ? uniform(random, -1, 1) * radius : uniform(random, -0.2, 1.5);
            const Point3 met = center + across * from_axis - way * back;
            const double error = round % 4 == 0 ? 0x1p-48 : 0x1p-24 * uniform(random, 0, 1);
            const Vector3 d = way * (1.5 / max_norm(way));
            float square = 0;
            for (int axis = 0; axis < 3; ++axis) {
                ray.lanes.step[0][axis] = d[axis];
                ray.lanes.direction[0][axis] = static_cast<float>(d[axis]);
                square =
                    std::fma(ray.lanes.direction[0][axis], ray.lanes.direction[0][axis], square);
                ray.lanes.origin[0][axis] = met[axis] - static_cast<double>(ray.entry) * d[axis];
            }
            ray.lanes.inverse[0][3] = ray.entry;  // the origin's parameter
            ray.lanes.near_add[0][3] = square;
            ray.lanes.far_add[0][3] = static_cast<float>(error);
            // Stored rounded; the truth is off by u on each axis, and by u r.
            const double sense = round % 8 < 4 ? 1 : -1;
            const Vector3 push = signs_of(across) * sense;
            RealVector c, o;
            float values[4 * kLeafLanes] = {};
            for (int axis = 0; axis < 3; ++axis) {
                const auto i = static_cast<std::size_t>(axis) * kLeafLanes;
                values[i] = static_cast<float>(center[axis]);
                c[axis] = Real(values[i]) + Real(0x1p-24) * push[axis];
                o[axis] =
                    Real(ray.lanes.origin[0][axis]) - Real(ray.lanes.far_add[0][3]) * push[axis];
            }
            values[3 * kLeafLanes] = radius;
            const Real r = Real(radius) * (1 - Real(0x1p-24) * sense);
            const RealVector f = o - c, step(d);
            const Real a = dot(step, step), b = dot(f, step);
            const Real depth = b * b - a * (dot(f, f) - r * r);
            const bool front = round % 16 < 8;
            LeafAnswers found;
            ask({ray.lanes, ray.head, ray.entry, front ? 1U : 0U}, values, found);
            const bool is_sure = (found.sure & 1) != 0, is_open = (found.open & 1) != 0;
            sure += is_sure;
            open += is_open;
            missed += !is_sure && !is_open;
            const std::string where =
                "seed " + std::to_string(kSeed + 2) + ", round " + std::to_string(round);
            const Real behind(ray.lanes.inverse[0][3]);
            std::optional<Real> s;
            if (depth >= 0) {
                const Real near = (-b - sqrt(depth)) / a, far = (-b + sqrt(depth)) / a;
                if (near > behind)
                    s = near;
                else if (far > behind && !front)
                    s = far;
            }
            if (!s) {
                ASSERT_FALSE(is_sure) << where;
                continue;
            }
            ASSERT_TRUE(is_sure || is_open) << where;
            ASSERT_LE(Real(found.low[0]), *s) << where;
            ASSERT_GE(Real(found.high[0]), *s) << where;
            if (!is_sure) continue;
            narrow += found.high[0] - found.low[0] < 0x1p-12F * found.high[0];
            const Real middle = (Real(found.low[0]) + Real(found.high[0])) / 2;
            attain(share, abs(*s - middle), (Real(found.high[0]) - Real(found.low[0])) / 2);
        }
        EXPECT_GT(sure, 6000);
        EXPECT_GT(narrow, 2000);
        EXPECT_GT(missed, 5000) << open;
        EXPECT_GT(share, 0.1);
    }
}

}  // namespace
}  // namespace nuvo::testing
#endif
