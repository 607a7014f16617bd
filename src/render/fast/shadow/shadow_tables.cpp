#include "fast/shadow/shadow_tables.h"

#include <algorithm>
#include <cmath>

#include "fast/light/shadow_planes.h"
#include "fast/light/wanted_items.h"
#include "nuvo/geometry/predicates.h"
#include "nuvo/math/error_bounds.h"
#include "nuvo/math/parallel.h"

namespace nuvo {
namespace {

// A surface that P touches passes within 2 sqrt(3) + 3/4 of P's error. [numerics: shadow ends]
constexpr double kTouch = 8;

// The sphere around an ellipsoid, so wide that a point outside is not taken to touch it: touching
// points have |F| <= R' + (1 + sqrt 2) e |rho| in the terms of numerics: shadow ends, and outside
// of a sphere of radius (1 + s) times the longest axis |F| > (1 + s) R'.
// In the local frame, where no square of what matters leaves the range of doubles; infinite or NaN
// where the ellipsoid is too thin for them.
double radius_around(const Matrix3& linear, double error) {
    const Matrix3 adjugate = linear.adjugate();
    double rho = 0;
    double longest = 0;
    for (int i = 0; i < 3; ++i) {
        rho += norm1(adjugate.row[i]);
        longest += dot(linear.row[i], linear.row[i]);
    }
    const double volume = dot(linear.row[0], adjugate.column(0));
    return std::sqrt(longest) * (1 + 4 * error * rho / std::fabs(volume)) * (1 + gamma(64)) +
           kFloatUnderflow;
}

}  // namespace

void ShadowTable::hold_triangles(Slot count) {
    constexpr std::size_t kReadAhead = 3;  // bytes behind the last of `hides`, which may be read
    triangles = count;
    planes.resize(count);
    hides.assign(count / 8 + kReadAhead, 0);
}

ShadowTables::ShadowTables(const FastScene& scene, InstructionSet isa, int threads,
                           std::vector<std::optional<WantedDepths>> wanted, LightRange lights)
    : scene_(scene),
      isa_(isa),
      threads_(threads),
      lights_(lights),
      dense_(rounded_up(scene.frame().dense)) {
    make_tables();
    for_each_part(threads, quadrics_.size(), [&](std::size_t begin, std::size_t end) {
        take_quadrics(scene.quadrics().subspan(begin, end - begin));
    });
    wanted.resize(tables_.size());
    std::vector<std::size_t> listed;
    std::vector<std::size_t> whole;
    for (std::size_t light = 0; light < tables_.size(); ++light) {
        if (!serves(light)) continue;
        forget_outside(tables_[light]);
        if (wanted[light]) {
            list_wanted(tables_[light], light, std::move(*wanted[light]));
            listed.push_back(light);
        } else {
            whole.push_back(light);
        }
    }
    const auto fill_buffers = [&](const std::vector<std::size_t>& some) {
        for_each_index(threads, some.size(),
                       [&](std::size_t i, int) { fill_buffer(tables_[some[i]]); });
    };
    fill_buffers(listed);
    make_planes_of_all();
    fill_buffers(whole);
}

void ShadowTables::make_tables() {
    // A surface point's error is at most surface_tolerance() of its primitive's coordinates, where
    // an ellipsoid counts with its reach, at most twice these; and the roundings of the point.
    touch_ = 4 * surface_tolerance() * scene_.largest_coordinate() * scene_.frame().scale +
             kFloatUnderflow;
    plane_error_ = rounded_up(2 * touch_ + kFloatUnderflow);
    quadric_touch_ = rounded_up(kTouch * touch_ + kFloatUnderflow);
    quadrics_.resize(scene_.slot_end() - scene_.triangle_end());
    const std::vector<Light>& lights = scene_.scene().lights;
    for (std::size_t light = 0; light < lights.size(); ++light) {
        ShadowTable& table = tables_.emplace_back(LightPoint(lights[light], scene_.frame()));
        if (!serves(light)) continue;
        if (!outside_of_all(table.light) || !scene_.primitives().all_cast_shadows)
            table.quadric_sides.resize(quadrics_.size());
    }
}

void ShadowTables::make_planes_of_all() {
    std::vector<std::size_t> lights;
    for (std::size_t light = 0; light < tables_.size(); ++light) {
        ShadowTable& table = tables_[light];
        if (!table.complete() || !serves(light)) continue;
        table.hold_triangles(scene_.triangle_end());
        lights.push_back(light);
    }
    if (lights.empty()) return;
    for_each_chunk(scene_, {}, scene_.triangle_end(), threads_, [&](const TriangleChunk& chunk) {
        for (const std::size_t light : lights) make_planes(tables_[light], light, chunk);
    });
}

void ShadowTables::list_wanted(ShadowTable& table, std::size_t light, WantedDepths wanted) {
    table.wanted = std::move(wanted);
    table.slots = wanted_items(items(), *table.wanted, isa_, threads_);
    LightItems listed = items();
    listed.slots = table.list();
    table.hold_triangles(listed.triangles());
    for_each_chunk(scene_, table.list(), table.triangles, threads_,
                   [&](const TriangleChunk& chunk) { make_planes(table, light, chunk); });
}

void ShadowTables::fill_buffer(ShadowTable& table) const {
    LightItems held = items();
    held.slots = table.list();
    held.hides = table.hides.data();
    table.buffer = LightBuffer(table.light, held, isa_);
    if (table.wanted) table.buffer.map.most_moved = table.wanted->map().most_moved;
    if (table.buffer.usable()) return;
    // Walks of the octree ask for all.
    table.wanted.reset();
    table.slots = {};
}

void ShadowTables::make_planes(ShadowTable& table, std::size_t light,
                               const TriangleChunk& chunk) const {
    const ShadowPlanesJob job{scene_, table.light, table.planes.data(), table.hides.data(),
                              scene_.scene().lights[light]};
    make_shadow_planes(job, chunk, isa_);
}

void ShadowTables::take_quadrics(QuadricSpan quadrics) {
    for (const QuadricSlot& quadric : quadrics) {
        scene_.prefetched_after(quadric);
        const std::size_t i = quadric.slot - scene_.triangle_end();
        const Object& object = scene_.object(quadric.id);
        quadrics_[i] = quadric_of(quadric);
        for (ShadowTable& table : tables_)
            if (!table.quadric_sides.empty())
                table.quadric_sides[i] = side(table.light, quadrics_[i], object);
    }
}

LocalSphere ShadowTables::quadric_of(const QuadricSlot& quadric) const {
    if (quadric.slot < scene_.sphere_end())
        return scene_.local(std::get<Sphere>(scene_.object(quadric.id).shape));
    const BallMap& ball = scene_.ball(quadric.slot);
    return {Vec3<float>(ball.center), static_cast<float>(radius_around(ball.from_unit, touch_))};
}

bool ShadowTables::outside_of_all(const LightPoint& light) const {
    if (!light.finite) return false;
    if (light.weight == 0) return true;
    if (scene_.sphere_end() != scene_.slot_end()) return false;  // what is around them is not in it
    const Bounds3T<float>& box = scene_.octree().bounds;
    // As in side(), where no quadric is larger than the scene reaches.
    const double error = rounded_up(kQuadricError * scene_.reach() + quadric_touch_);
    const double margin = 2 * error + roundings(8) * scene_.reach();
    for (int axis = 0; axis < 3; ++axis)
        if (light.toward[axis] > (box.max[axis] + margin) * light.weight ||
            light.toward[axis] < (box.min[axis] - margin) * light.weight)
            return true;
    return false;
}

void ShadowTables::forget_outside(ShadowTable& table) {
    if (std::all_of(table.quadric_sides.begin(), table.quadric_sides.end(),
                    [](LightSide side) { return side == LightSide::kOutside; }))
        table.quadric_sides.clear();
}

LightSide ShadowTables::side(const LightPoint& light, const LocalSphere& shape,
                             const Object& object) const {
    if (!object.casts_shadow) return LightSide::kNoShadow;
    if (!light.finite) return LightSide::kUnknown;
    const Vector3 from(shape.center);
    const double distance = length(from * light.weight - light.toward);
    const double radius = shape.radius * light.weight;
    const double error = quadric_touch_ + kQuadricError * size_of(shape);
    const double margin = 2 * error * light.weight + roundings(4) * radius;
    if (distance > radius + margin) return LightSide::kOutside;
    if (!(distance < radius - margin)) return LightSide::kUnknown;
    const bool blind = scene_.front_only(object) && std::holds_alternative<Sphere>(object.shape);
    return blind ? LightSide::kNoShadow : LightSide::kInside;
}

bool ShadowTables::complete() const {
    return std::all_of(tables_.begin(), tables_.end(),
                       [](const ShadowTable& table) { return table.complete(); });
}

std::size_t ShadowTables::memory_bytes() const {
    std::size_t bytes = quadrics_.size() * sizeof(LocalSphere);
    for (const ShadowTable& table : tables_)
        bytes += table.slots.size() * sizeof(Slot) + table.planes.size() * sizeof(ShadowPlanes) +
                 table.hides.size() + table.quadric_sides.size() * sizeof(LightSide) +
                 table.buffer.memory_bytes() + (table.wanted ? table.wanted->memory_bytes() : 0);
    return bytes;
}

}  // namespace nuvo
