#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <set>
#include <tuple>

#include "geometry/worst_case.h"
#include "predicates_quadratic.h"

// What is decided of a t^2 + 2 b t + c known within bounds must hold of every polynomial within
// them; and it is decided where it holds within bounds several times as wide.
namespace nuvo {
namespace {

using detail::Decision;
using detail::OriginPlace;
using RoundedQuadratic = detail::RoundedQuadratic<double>;
using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<80>,
                                           boost::multiprecision::et_off>;
using worst_case::Draw;

constexpr unsigned kSeed = 20261130;
constexpr double kEndless = std::numeric_limits<double>::infinity();

struct Polynomial {
    Real a, b, c;
    Real depth() const { return (b * b - a * c) / a; }
    Real at(const Real& t) const { return t * (a * t + 2 * b) + c; }
};

/// Definition 1 and 2: the root that a ray sees.
struct Seen {
    bool any = false;
    SphereRoot which{};
    Real t;
};
Seen seen(const Polynomial& p, Sides sides) {
    const Real d = p.depth();
    if (d < 0) return {};
    const Real root = sqrt(Real(d * p.a));
    const Real large = p.b < 0 ? Real(root - p.b) : Real(-root - p.b);
    const Real small = large == 0 ? Real(0) : Real(p.c / large);
    const Real near = p.b < 0 ? small : Real(large / p.a);
    const Real far = p.b < 0 ? Real(large / p.a) : small;
    if (near > 0) return {true, SphereRoot::kNear, near};
    if (sides == Sides::kBoth && far > 0) return {true, SphereRoot::kFar, far};
    return {};
}

/// Definition 4, with both ends open, by the polynomial's sign at the end and the vertex' side.
bool blocks(const Polynomial& p, double end, OriginPlace place, Sides sides) {
    const bool endless = std::isinf(end);
    const Real power = endless ? Real(1) : p.at(Real(end));
    const bool beyond = endless || p.a * Real(end) + p.b > 0;
    if (place == OriginPlace::kOnIt) return p.b < 0 && power > 0;
    if (p.depth() < 0) return false;
    // By the roots: both lie before the end, the near one alone, or none.
    const bool far_before_end = power > 0 && beyond;
    const bool near_before_end = far_before_end || power < 0;
    const bool far_ahead = p.c < 0 || (p.c == 0 && p.b < 0) || (p.c > 0 && p.b < 0);
    const bool near_ahead = p.c > 0 && p.b < 0;
    if (place == OriginPlace::kTouching) return p.b < 0 && far_before_end;
    if (far_ahead && far_before_end) return true;
    return sides == Sides::kBoth && near_ahead && near_before_end;
}

/// A polynomial with bounds of about 2^least and more.
RoundedQuadratic rounded(Draw& draw, double least) {
    RoundedQuadratic q{};
    const double scale = draw.size(-20, 20);
    const double near = draw.uniform(-1, 1) * scale;
    const double far =
        draw.below(3) == 0 ? near + draw.size(-40, 0) * scale : draw.uniform(-1, 1) * scale;
    q.a = draw.size(-10, 10);
    q.b = -q.a * ((near + far) / 2);
    q.c = q.a * near * far;
    if (draw.below(6) == 0) q.c += q.a * scale * scale * draw.size(-40, 0);
    const bool exact = draw.below(4) == 0;  // leaves the roundings of the decision itself
    const auto error = [&] {
        return exact || draw.below(8) == 0 ? 0 : draw.size(least, least + 20);
    };
    const double size = q.a * scale;
    q.a_relative = error();
    q.b_error = error();
    q.b_error *= draw.below(2) != 0 ? std::fabs(q.b) : size;
    q.c_error = error();
    q.c_error *= draw.below(2) != 0 ? std::fabs(q.c) : size * scale;
    q.depth = (q.b * q.b - q.a * q.c) / q.a;
    q.length = std::sqrt(q.a);
    return q;
}
/// The polynomial and others with bounds `times` as wide, and `more` of each number.
std::vector<Polynomial> within(const RoundedQuadratic& q, double times, double more = 0) {
    const Real a_error = Real(q.a) * (Real(times) * Real(q.a_relative) + Real(more));
    const Real b_error = Real(times) * Real(q.b_error) + Real(more * std::fabs(q.b));
    const Real c_error = Real(times) * Real(q.c_error) + Real(more * std::fabs(q.c));
    std::vector<Polynomial> all;
    for (const int i : {0, -1, 1})
        for (const int j : {0, -1, 1})
            for (const int k : {0, -1, 1})
                all.push_back(
                    {Real(q.a) + i * a_error, Real(q.b) + j * b_error, Real(q.c) + k * c_error});
    return all;
}
int sign(const Real& x) { return x < 0 ? -1 : x > 0 ? 1 : 0; }
/// All that an answer can hang on has the same sign, not 0.
template <typename Signs>
bool alike(const std::vector<Polynomial>& all, Signs&& signs) {
    std::set<std::vector<int>> found;
    for (const Polynomial& p : all) found.insert(signs(p));
    return found.size() == 1 &&
           found.begin()->end() == std::find(found.begin()->begin(), found.begin()->end(), 0);
}
/// The depth's error as the others imply it, and the roundings of depth itself.
void bound_depth(RoundedQuadratic& q) {
    Real most = 0;
    for (const Polynomial& p : within(q, 1))
        most = std::max(most, Real(abs(Real(p.depth() - Real(q.depth)))));
    q.depth_error = static_cast<double>(most) * (1 + 0x1p-50);
}

TEST(QuadraticDecisions, TheRootSeenIsThatOfEveryPolynomialWithinTheBounds) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
    Draw draw(kSeed);
    int yes = 0;
    int no = 0;
    for (int i = 0; i < 2000; ++i) {
        RoundedQuadratic q = rounded(draw, draw.below(4) != 0 ? -72 : -50);
        bound_depth(q);
        const Sides sides = draw.below(2) != 0 ? Sides::kBoth : Sides::kFront;
        SphereHit hit{};
        const Decision decision = detail::rounded_hit(q, sides, hit);
        const auto as_found = [&](const Polynomial& p, bool any, SphereRoot which, double t,
                                  double tolerance) {
            const Seen truth = seen(p, sides);
            if (truth.any != any || (any && truth.which != which)) return false;
            return !any || abs(Real(truth.t - Real(t))) <= Real(tolerance) * truth.t;
        };
        if (decision != Decision::kUnsure) {
            (decision == Decision::kYes ? yes : no)++;
            for (const Polynomial& p : within(q, 1))
                ASSERT_TRUE(as_found(p, decision == Decision::kYes, hit.which, hit.root.t,
                                     root_tolerance()))
                    << "case " << i;
            if (decision == Decision::kYes) {
                EXPECT_EQ(hit.root.low, hit.root.t * (1 - root_tolerance()));
                EXPECT_EQ(hit.root.high, hit.root.t * (1 + root_tolerance()));
            }
            continue;
        }
        // Near tangency depth's own rounding decides, which the others do not imply; and a counts
        // twice, by itself and by depth, where the polynomials have but one.
        if (q.depth_error > 0x1p-36 * std::fabs(q.depth) || q.a_relative > 0x1p-48) continue;
        const std::vector<Polynomial> wide = within(q, 12, 0x1p-50);
        const Seen first = seen(wide[0], sides);
        bool all = alike(wide, [](const Polynomial& p) {
            return std::vector{sign(p.b), sign(p.c), sign(p.depth())};
        });
        for (const Polynomial& p : wide)
            all = all && as_found(p, first.any, first.which, static_cast<double>(first.t),
                                  root_tolerance());
        EXPECT_FALSE(all) << "case " << i << " was not decided";
    }
    EXPECT_GT(yes, 300);
    EXPECT_GT(no, 300);
}

TEST(QuadraticDecisions, WhatBlocksIsWhatEveryPolynomialWithinTheBoundsDoes) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
    Draw draw(kSeed + 1);
    int decided[2] = {0, 0};
    for (int i = 0; i < 4000; ++i) {
        RoundedQuadratic q = rounded(draw, draw.below(2) != 0 ? -58 : -40);
        bound_depth(q);
        const Sides sides = draw.below(2) != 0 ? Sides::kBoth : Sides::kFront;
        const bool on_it = draw.below(4) == 0;
        const double size = std::fabs(q.c);
        const double band = draw.below(2) != 0 ? 0
                            : draw.below(2) != 0
                                ? draw.size(-3, 3) * size
                                : std::fmax(0.0, size + draw.uniform(-3, 3) * q.c_error);
        // The end: none, anywhere, or about a root.
        const double root =
            (-q.b + (draw.below(2) != 0 ? 1 : -1) * std::sqrt(q.a * std::fmax(0.0, q.depth))) / q.a;
        const double sense = draw.uniform(-1, 1);
        const double end = draw.below(4) == 0 ? kEndless
                           : draw.below(2) != 0
                               ? std::fabs(root) * draw.size(-1, 1)
                               : std::fabs(root) * (1 + sense * draw.size(-50, -10));
        const auto truth = [&](const Polynomial& p) {
            const OriginPlace place = on_it                    ? OriginPlace::kOnIt
                                      : abs(p.c) <= Real(band) ? OriginPlace::kTouching
                                                               : OriginPlace::kClear;
            return blocks(p, end, place, sides);
        };
        const Decision decision = detail::rounded_blocks(q, end, {band, 0}, on_it, sides);
        if (decision != Decision::kUnsure) {
            const bool yes = decision == Decision::kYes;
            ++decided[yes];
            for (const Polynomial& p : within(q, 1)) ASSERT_EQ(truth(p), yes) << "case " << i;
            continue;
        }
        const bool all = alike(within(q, 8, 0x1p-47), [&](const Polynomial& p) {
            const Real end_power = std::isinf(end) ? Real(1) : p.at(Real(end));
            const Real slope = std::isinf(end) ? Real(1) : Real(p.a * Real(end) + p.b);
            const Real past_band = on_it ? Real(1) : Real(abs(p.c) - Real(band));
            return std::vector{sign(p.b),       sign(p.c),   sign(p.depth()),
                               sign(end_power), sign(slope), sign(past_band)};
        });
        EXPECT_FALSE(all) << "case " << i << " was not decided";
    }
    EXPECT_GT(decided[0], 1000);
    EXPECT_GT(decided[1], 1000);
}

// f + t g at a root is l - or + root / |g| along g: with l, depth and a anywhere within their
// bounds (g along x, exact; l known within offset_error).
TEST(QuadraticDecisions, AnOffsetsErrorCoversEveryRootWithinTheBounds) {
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
    Draw draw(kSeed + 2);
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 2000; ++i) {
        RoundedQuadratic q{};
        const double g = draw.size(-10, 10);
        q.g = {g, 0, 0};
        q.l = {0, draw.uniform(-1, 1), 0};
        q.length = g;
        q.a = g * g;
        q.depth = draw.size(-10, 10);
        const int what = draw.below(3);
        q.a_relative = what == 0 ? draw.size(-50, -20) : 0;
        q.depth_error = what == 1 ? q.depth * draw.size(-50, -3) : 0;
        q.offset_error = what == 2 ? draw.size(-50, -10) : 0;
        const SphereRoot which = draw.below(2) != 0 ? SphereRoot::kNear : SphereRoot::kFar;
        const detail::RoundedOffset found = detail::rounded_offset(q, which);
        if (!std::isfinite(found.error)) {
            EXPECT_GT(q.depth_error, 0.24 * q.depth);
            continue;
        }
        EXPECT_EQ(found.offset.y, q.l.y);
        EXPECT_EQ(found.offset.z, 0);
        for (const int j : {-1, 1}) {
            const Real depth = Real(q.depth) + j * Real(q.depth_error);
            // A direction that is off by a_relative / 2 carries the point as far along.
            const Real root = sqrt(depth) * (1 + j * Real(q.a_relative));
            const Real x = which == SphereRoot::kNear ? Real(-root) : root;
            const Real error = abs(Real(Real(found.offset.x) - x)) + Real(q.offset_error);
            ASSERT_LE(error, Real(found.error)) << "case " << i;
            if (error > Real(0x1p-49) * root)
                least = std::fmin(least, static_cast<double>(Real(found.error) / error));
        }
    }
    EXPECT_LT(least, 1.1);
}

}  // namespace
}  // namespace nuvo
