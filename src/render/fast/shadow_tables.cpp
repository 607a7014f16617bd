#include "shadow_tables.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "nuvo/geometry/predicates.h"
#include "nuvo/math/error_bounds.h"
#include "shadow_planes.h"

namespace nuvo {
namespace {

constexpr double kFloatRoundoff = 0x1p-24;
// More than what the products of a float stage lose below the normal range.
constexpr double kFloatUnderflow = 0x1p-120;

// n.P + w with |n|_1 = 1 and |P|, |w| <= reach. Coefficients: one rounding; w + z + y + x: four of
// a term at most without fused operations; the plane itself is known to one roundoff of 2 reach:
// 2 (1 + 4 + 1) of reach, and a few more.
constexpr double kPlaneRoundings = 16;

// In units of reach: center and point rounded and subtracted (6), the vector to the nearest point
// of the line (12) at a parameter that is itself rounded (20), its square and the radius (13), the
// direction to the light, which carries the roundings of both its ends (35).
constexpr double kRoundRoundings = 128;
// A surface that P touches passes within 2 sqrt(3) + 3/4 of P's error. [numerics: shadow ends]
constexpr double kTouch = 8;

float rounded_up(double value) {
    return static_cast<float>(value * (1 + 2 * kFloatRoundoff) + kFloatUnderflow);
}

double largest_coordinate(const Primitives& primitives) {
    double largest = 0;
    for (const Bounds3& box : primitives.item_boxes)
        largest = std::fmax(largest, std::fmax(max_norm(box.min), max_norm(box.max)));
    return largest;
}

// The sphere around an ellipsoid, so wide that a point outside is not taken to touch it: touching
// points have |F| <= R' + (1 + sqrt 2) e |rho| in the terms of numerics: shadow ends, and outside
// of a sphere of radius (1 + s) times the longest axis |F| > (1 + s) R'.
double radius_around(const Ellipsoid& ellipsoid, double error) {
    const Matrix3 adjugate = ellipsoid.linear.adjugate();
    double rho = 0;
    double longest = 0;
    for (int i = 0; i < 3; ++i) {
        const Vector3& row = adjugate.row[i];
        rho += std::fabs(row.x) + std::fabs(row.y) + std::fabs(row.z);
        longest += dot(ellipsoid.linear.row[i], ellipsoid.linear.row[i]);
    }
    const double volume = dot(ellipsoid.linear.row[0], adjugate.column(0)) * ellipsoid.radius;
    return std::sqrt(longest) * ellipsoid.radius * (1 + 4 * error * rho / std::fabs(volume)) *
           (1 + gamma(64));
}

}  // namespace

LightPoint::LightPoint(const Light& light, const LocalFrame& frame) {
    if (light.kind == Light::Kind::kDirectional) {
        toward = -light.direction;
        return;
    }
    toward = frame.local(light.location);
    weight = 1;
    const double norm = max_norm(toward);
    if (norm > 1) {
        int exponent = 0;
        std::frexp(norm, &exponent);
        weight = std::ldexp(1.0, -exponent);
        toward = toward * weight;
    }
    finite = std::isfinite(norm) && std::isfinite(toward.x + toward.y + toward.z);
}

ShadowTables::ShadowTables(const FastScene& scene, InstructionSet isa, int threads)
    : scene_(scene) {
    const Bounds3T<float>& box = scene.octree().bounds;
    reach_ = std::fmax(max_norm(box.min), max_norm(box.max));
    if (!std::isfinite(reach_)) reach_ = 1;  // an empty scene
    // A surface point's error is at most surface_tolerance() of its primitive's coordinates, where
    // an ellipsoid counts with its reach, at most twice these; and the roundings of the point.
    touch_ =
        4 * surface_tolerance() * largest_coordinate(scene.primitives()) * scene.frame().scale +
        kFloatUnderflow;
    plane_error_ = rounded_up(kPlaneRoundings * kFloatRoundoff * reach_ + 2 * touch_);
    round_error_ = rounded_up(kRoundRoundings * kFloatRoundoff * reach_ + kTouch * touch_);
    const auto nodes = static_cast<double>(scene.octree().nodes.size());
    leaf_width_ = static_cast<float>(2 * reach_ / std::cbrt(nodes + 1));
    add_rounds();
    const std::vector<Light>& lights = scene.scene().lights;
    const auto casts = [](const Light& light) { return light.casts_shadow; };
    planes_.resize(static_cast<std::size_t>(std::count_if(lights.begin(), lights.end(), casts)) *
                   scene.triangle_end());
    std::size_t made = 0;
    for (const Light& light : lights) {
        ShadowTable& table = tables_.emplace_back(LightPoint(light, scene.frame()));
        if (!light.casts_shadow) continue;
        table.first_plane = made;
        made += scene.triangle_end();
        add_planes(light, table, isa, threads);
        add_sides(table);
    }
}

void ShadowTables::add_planes(const Light& light, const ShadowTable& table, InstructionSet isa,
                              int threads) {
    const Slot end = scene_.triangle_end();
    ShadowPlanes* const planes = planes_.data() + table.first_plane;
    if (!table.light.finite) {
        std::fill(planes, planes + end, ShadowPlanes{});
        return;
    }
    const auto make = [&](Slot first, Slot last) {
        make_shadow_planes({scene_, table.light, reach_, first, last, planes, light}, isa);
    };
    // Fewer triangles than this are done before a thread has started.
    constexpr Slot kShare = 1 << 13;
    const Slot share = std::max(kShare, (end + threads - 1) / threads);
    std::vector<std::jthread> others;
    for (Slot first = share; first < end; first += share)
        others.emplace_back(make, first, std::min(end, first + share));
    make(0, std::min(end, share));
}

void ShadowTables::add_rounds() {
    const LocalFrame& frame = scene_.frame();
    rounds_.resize(scene_.rounds().size());
    for (const auto& [id, slot] : scene_.rounds()) {
        const Shape& shape = scene_.scene().objects[scene_.primitives().sources[id].object].shape;
        Point3 center;
        double radius = 0;
        if (const auto* sphere = std::get_if<Sphere>(&shape)) {
            center = sphere->center;
            radius = sphere->radius;
        } else {
            const auto& ellipsoid = std::get<Ellipsoid>(shape);
            center = ellipsoid.center;
            radius = radius_around(ellipsoid, touch_ / frame.scale);
        }
        const Point3 local = frame.local(center);
        rounds_[slot - scene_.triangle_end()] = {
            {static_cast<float>(local.x), static_cast<float>(local.y), static_cast<float>(local.z)},
            static_cast<float>(radius * frame.scale)};
    }
}

void ShadowTables::add_sides(ShadowTable& table) const {
    const LightPoint& light = table.light;
    if (light.weight == 0 && light.finite) return;
    std::vector<LightSide> sides(rounds_.size(), LightSide::kUnknown);
    bool all_outside = true;
    for (std::size_t i = 0; i < rounds_.size() && light.finite; ++i) {
        const RoundShape& shape = rounds_[i];
        const Vector3 from{shape.center[0], shape.center[1], shape.center[2]};
        const double distance = length(from * light.weight - light.toward);
        const double radius = shape.radius * light.weight;
        const double margin = 2 * round_error_ * light.weight + 4 * kFloatRoundoff * radius;
        if (distance > radius + margin)
            sides[i] = LightSide::kOutside;
        else if (distance < radius - margin)
            sides[i] = LightSide::kInside;
        all_outside &= sides[i] == LightSide::kOutside;
    }
    if (!all_outside || !light.finite) table.round_sides = std::move(sides);
}

std::size_t ShadowTables::memory_bytes() const {
    std::size_t bytes = rounds_.size() * sizeof(RoundShape) + planes_.size() * sizeof(ShadowPlanes);
    for (const ShadowTable& table : tables_) bytes += table.round_sides.size() * sizeof(LightSide);
    return bytes;
}

}  // namespace nuvo
