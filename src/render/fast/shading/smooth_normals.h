// No #pragma once: compiled once for each instruction set (see hwy/foreach_target.h).
#if defined(NUVO_RENDER_FAST_SMOOTH_NORMALS_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NUVO_RENDER_FAST_SMOOTH_NORMALS_H_
#undef NUVO_RENDER_FAST_SMOOTH_NORMALS_H_
#else
#define NUVO_RENDER_FAST_SMOOTH_NORMALS_H_
#endif

#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "fast/shading/block_directions.h"
#include "fast/shading/shading.h"
#include "fast/simd/lanes.h"
#include "fast/simd/vector_math.h"
#include "nuvo/math/error_bounds.h"

// Surfaces whose normal or color varies within the primitive: for each primitive that a block
// shows, its functions of the pixel are evaluated for all 16 lanes. The vectors f x d (sphere) and
// the edge functions (triangle) are affine in the pixel, so a lane costs a few operations.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

/// The steps of a block's lanes to the right and down.
struct alignas(64) BlockSteps {
    constexpr BlockSteps() {
        for (int lane = 0; lane < kBlockLanes; ++lane) {
            right[lane] = static_cast<float>(lane_x(lane));
            down[lane] = static_cast<float>(lane_y(lane));
            right_double[lane] = lane_x(lane);
            down_double[lane] = lane_y(lane);
        }
    }
    float right[kBlockLanes] = {};
    float down[kBlockLanes] = {};
    double right_double[kBlockLanes] = {};
    double down_double[kBlockLanes] = {};
};
inline constexpr BlockSteps kSteps;

/// first + right * (steps right) + down * (steps down).
HWY_INLINE Doubles affine(double first, double right, double down) {
    return mul_add(Doubles::load(kSteps.right_double), Doubles(right),
                   mul_add(Doubles::load(kSteps.down_double), Doubles(down), Doubles(first)));
}

/// From an estimate in float one step of Newton's, which squares its error: within 2^-44.
HWY_INLINE Doubles precise_reciprocal(const Doubles& v) {
    const Doubles e = doubles_from(reciprocal(floats_from(v)));
    return e * neg_mul_add(v, e, Doubles(2.0));
}

/// Fills lanes of one block.
class SmoothNormalLanes {
  public:
    SmoothNormalLanes(const ShadingTables& tables, Tile& tile, ShadingScratch& scratch,
                      const BlockDirections& directions, int b)
        : tables_(tables),
          scene_(tables.scene),
          tile_(tile),
          scratch_(scratch),
          first_(b * kBlockLanes),
          directions_(directions),
          block_(b),
          center_x_(static_cast<float>(tables.camera.center_x(tile.x + lane_x(first_)))),
          center_y_(static_cast<float>(tables.camera.center_y(tile.y + lane_y(first_)))),
          first_direction_(tables.camera.direction(static_cast<double>(center_x_),
                                                   static_cast<double>(center_y_))),
          first_offset_(
              tables.camera.offset(static_cast<double>(center_x_), static_cast<double>(center_y_))),
          starts_(CameraExtent(tables.camera).starts) {}

    HWY_NOINLINE void fill(std::uint32_t lanes) {
        const Ints slots = Ints::load(tile_.slot + first_);
        while (lanes != 0) {
            const Slot slot = tile_.slot[first_ + std::countr_zero(lanes)];
            const std::uint32_t same = (slots == Ints(slot)).bits() & lanes;
            lanes &= ~same;
            lanes_ = RayMask::from_bits(same);
            bits_ = same;
            if (slot < scene_.triangle_end())
                fill_triangle(slot);
            else
                fill_quadric(slot, tables_.quadrics.seen(slot));
        }
        if (smooth_bits_ != 0) finish_smooth();
    }

  private:
    static constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    static constexpr float kSecondRound = 1 + roundings(8);

    // The function of the plane through a point with that normal. [camera_triangle_lanes.h]
    HWY_INLINE Doubles plane_function(const Vector3& normal, const Point3& point) const {
        const bool parallel = tables_.camera.parallel;
        return affine(dot(normal, parallel ? first_offset_ - point : first_direction_),
                      dot(normal, tables_.camera.right), dot(normal, tables_.camera.down));
    }
    // The lanes that are not `known` get NaN, and the fallback.
    HWY_INLINE void store_normal(const Floats (&n)[3], const RayMask& known, const Floats& error) {
        for (int i = 0; i < 3; ++i)
            select(known, n[i], Floats(kNan)).store(tile_.normal[i] + first_, lanes_);
        error.store(scratch_.normal_error + first_, lanes_);
        give_up(without(lanes_, known));
        scratch_.smooth[block_] = static_cast<std::uint16_t>(scratch_.smooth[block_] | bits_);
    }
    HWY_INLINE void give_up(const RayMask& lanes) {
        Floats(kFloatInfinity).store(scratch_.diffuse_error + first_, lanes);
    }
    HWY_INLINE void store_point(const Floats (&p)[3], const RayMask& known, float error) {
        const RayMask stored = lanes_ & known;
        for (int i = 0; i < 3; ++i) p[i].store(tile_.point[i] + first_, stored);
        Floats(error).store(tile_.point_error + first_, stored);
    }

    // Directions first + right x + down y of the block's lanes; in a parallel projection all are
    // `first`, and rays start at `start` + right x + down y from the anchor.
    struct Rays {
        Vector3 first;
        Vector3 start;
        Vector3 right;
        Vector3 down;
        Floats d[3];
        Doubles square;  // d.d
        Floats inverse_square;
    };
    HWY_INLINE Rays rays_of(const Vector3& first, const Vector3& start, const Vector3& right,
                            const Vector3& down) const {
        const bool parallel = tables_.camera.parallel;
        Rays out{first, start, right, down, {}, Doubles(0.0), {}};
        for (int i = 0; i < 3; ++i) {
            const Doubles d = affine(first[i], parallel ? 0 : right[i], parallel ? 0 : down[i]);
            out.square = mul_add(d, d, out.square);
            out.d[i] = floats_from(d);
        }
        out.inverse_square = reciprocal(floats_from(out.square));
        return out;
    }

    static constexpr double kDigits = 0x1p28;
    static constexpr float kSphereNormalError = roundings(14);
    struct UnitNormals {
        Floats n[3];
        RayMask known;
    };
    // m = f x d with f from the centre of the unit sphere to where the rays come from; the unit
    // normal is (d x m -+ s d) / d.d with s^2 = d.d - m.m. (Haines et al. 2019, "Precision
    // improvements for ray/sphere intersection".) s^2 is formed in double: below `noise` it is
    // that, and where it is 2^28 times that its float is good to the last digit. In float |m| <=
    // |d|, so d x m has the roundings of d and m and 3 more; s has its own, half of its square's
    // and the root's 3.2, with d and the product 5.2; 1 / d.d, its product and the sum 3: all that
    // is kSphereNormalError in units. `scale` times `from` is f, from the anchor in a parallel
    // projection.
    HWY_INLINE UnitNormals unit_normals(const Vector3& from, double scale, bool inside,
                                        double noise, const Rays& rays) const {
        const bool parallel = tables_.camera.parallel;
        const Vector3 f = (parallel ? from + rays.start : from) * scale;
        const Vector3 first = cross(f, rays.first);
        const Vector3 right =
            parallel ? cross(rays.right * scale, rays.first) : cross(f, rays.right);
        const Vector3 down = parallel ? cross(rays.down * scale, rays.first) : cross(f, rays.down);
        Doubles rest = rays.square;
        Floats m[3];
        for (int i = 0; i < 3; ++i) {
            const Doubles value = affine(first[i], right[i], down[i]);
            rest = neg_mul_add(value, value, rest);
            m[i] = floats_from(value);
        }
        const Floats square = floats_from(rest);
        UnitNormals out;
        out.known = square > Floats(static_cast<float>(kDigits * noise));
        Floats s = square * inverse_sqrt(square);
        if (inside) s = -s;
        for (int i = 0; i < 3; ++i) {
            const int next = (i + 1) % 3;
            const int last = (i + 2) % 3;
            const Floats across = neg_mul_add(rays.d[last], m[next], rays.d[next] * m[last]);
            out.n[i] = neg_mul_add(s, rays.d[i], across) * rays.inverse_square;
        }
        return out;
    }

    HWY_INLINE void fill_sphere(const CameraSphere& sphere) {
        constexpr double kCrossError = 0x1p-49;  // 8 roundings of f x d
        constexpr double kSideError = 0x1p-48;
        const Vector3 from{sphere.from[0], sphere.from[1], sphere.from[2]};
        const double scale = 1 / sphere.exact_radius;
        const Vector3 f = from * scale;
        const double power = dot(f, f);
        // All rays of a parallel projection start outside, or some start perhaps inside.
        const bool outside = tables_.camera.parallel;
        const bool inside = power < 1 && !outside;
        const bool sure =
            outside ? !sphere.floats_cannot_tell : std::fabs(power - 1) > kSideError * (power + 1);
        if (!rays_)  // the block's once for all its spheres
            rays_ =
                rays_of(first_direction_, first_offset_, tables_.camera.right, tables_.camera.down);
        const auto longest = static_cast<double>(tables_.rays.longest);
        const double noise = kCrossError * (1 + norm1(f) + starts_ * scale) * longest * longest;
        const UnitNormals unit =
            unit_normals(from, scale, inside, sure ? noise : kInfinity, *rays_);
        const Point3 center = tables_.camera.origin - from;
        const float radius = sphere.radius;
        const float turn = inside && !sphere.solid ? -1 : 1;
        Floats normal[3];
        Floats point[3];
        for (int i = 0; i < 3; ++i) {
            point[i] = mul_add(unit.n[i], Floats(radius), Floats(static_cast<float>(center[i])));
            normal[i] = unit.n[i] * Floats(turn);
        }
        store_normal(normal, unit.known, Floats(kSphereNormalError));
        // P: of centre and sum, which is at most the radius more, and the radius's times the
        // normal's and two more.
        const float error = (kSphereNormalError + roundings(4)) * radius +
                            roundings(3) * static_cast<float>(length(center)) +
                            tables_.bounds.world_rounding;
        store_point(point, unit.known, error);
    }

    // The unit normal of the ball, taken back: by the map for points, by its transpose for normals,
    // whose length tells what their error counts. [numerics: ellipsoids as balls]
    HWY_INLINE void fill_ball(const BallMap& map, const CameraSphere& ball) {
        constexpr float kUnitError = kSphereNormalError + roundings(2);  // and the map's own
        const Vector3 from{ball.from[0], ball.from[1], ball.from[2]};
        const double scale = 1 / map.radius;
        const bool inside = ball.inverse_power < 0;
        const Rays rays =
            rays_of(map.to_ball * first_direction_, map.to_ball * first_offset_,
                    map.to_ball * tables_.camera.right, map.to_ball * tables_.camera.down);
        // F and G, not below f and d, carry 5 roundings of what the map may stretch; the map's own
        // error counts by |F x G|, not by |F| |G|.
        const double steps = kBlockSide * (length(rays.right) + length(rays.down));
        const double longest = length(rays.first) + (tables_.camera.parallel ? 0 : steps);
        const double f = (max_norm(from) + map.stretch * starts_) * scale;
        const double noise =
            longest * longest *
            (6 * (1 + 2 * f) * (2 * map.stretch * gamma(5) + gamma(8)) + 36 * map.error);
        const UnitNormals unit = unit_normals(from, scale, inside, noise, rays);
        const float turn = inside && !ball.solid ? -1 : 1;
        Floats normal[3];
        Floats point[3];
        Floats square(0.0F);
        double squares = 0;
        double longest_row = 0;
        for (int i = 0; i < 3; ++i) {
            const Vector3 across = map.to_ball.column(i);
            const Vector3& along = map.from_unit.row[i];
            squares += dot(across, across);
            longest_row = std::fmax(longest_row, norm1(along));
            normal[i] = mul_add(unit.n[0], Floats(static_cast<float>(across.x)),
                                mul_add(unit.n[1], Floats(static_cast<float>(across.y)),
                                        unit.n[2] * Floats(static_cast<float>(across.z))));
            square = mul_add(normal[i], normal[i], square);
            point[i] = mul_add(unit.n[0], Floats(static_cast<float>(along.x)),
                               mul_add(unit.n[1], Floats(static_cast<float>(along.y)),
                                       mul_add(unit.n[2], Floats(static_cast<float>(along.z)),
                                               Floats(static_cast<float>(map.center[i])))));
        }
        const Floats inverse = inverse_sqrt(square);
        for (Floats& n : normal) n = n * inverse * Floats(turn);
        // The sum carries the roundings of its matrix and 3 more of each term.
        const auto size = static_cast<float>(std::sqrt(squares));
        const Floats relative = inverse * Floats(size * (kUnitError + roundings(4)) * kSecondRound);
        const RayMask known = unit.known & (relative < Floats(kSmall));
        store_normal(normal, known, mul_add(relative, Floats(kSecondOrder), Floats(roundings(5))));
        const float error = (kUnitError + roundings(5)) * static_cast<float>(longest_row) +
                            roundings(3) * static_cast<float>(max_norm(map.center)) +
                            tables_.bounds.world_rounding;
        store_point(point, known, error);
    }

    // The primary stage has its normal from the fallback.
    HWY_INLINE void fill_ellipsoid(bool solid) {
        constexpr float kRootOf3 = 1.7320509F;  // rounded up
        Floats normal[3];
        Floats along(0.0F);
        for (int i = 0; i < 3; ++i) {
            normal[i] = Floats::load(tile_.ellipsoid_normal[i] + first_);
            along = mul_add(normal[i], directions_.at(i), along);
        }
        const Floats error = Floats::load(tile_.ellipsoid_normal_error + first_) * Floats(kRootOf3);
        RayMask known = lanes_;
        if (!solid) {
            const float longest = tables_.rays.longest;
            known = abs(along) > mul_add(error, Floats(longest), Floats(roundings(8) * longest));
            for (Floats& n : normal) n = select(along > Floats(0.0F), -n, n);
        }
        store_normal(normal, known, error);
    }

    HWY_INLINE void fill_triangle(Slot slot) {
        const SurfaceWord word = tables_.triangles.words[slot];
        const PrimitiveSource& source = scene_.source(slot);
        if ((word & kColoredFlag) != 0) fill_color(scene_.mesh(source), source.triangle);
        if ((word & kSmoothFlag) != 0)
            add_smooth(
                tables_.triangles.smooth[slot - tables_.triangles.smooth_offsets[source.object]]);
    }

    HWY_INLINE void fill_quadric(Slot slot, const SeenQuadric& seen) {
        if (!tables_.uniform) {
            const SurfaceWord word = tables_.material_words[seen.sphere->material];
            Ints(word).store(scratch_.word + first_, mask_for<std::int32_t>(lanes_));
        }
        if (seen.map != nullptr)
            fill_ball(*seen.map, *seen.sphere);
        else if (slot < scene_.sphere_end())
            fill_sphere(*seen.sphere);
        else
            fill_ellipsoid(seen.sphere->solid);
    }

    // The normal's direction in these lanes; its length waits for those of other triangles.
    HWY_INLINE void add_smooth(const SmoothTriangle& t) {
        // The first one fills all lanes, so that none is read unset.
        const RayMask lanes = smooth_bits_ == 0 ? RayMask::from_bits(0xffff) : lanes_;
        const Floats x = Floats::load(kSteps.right) + Floats(center_x_ - t.x);
        const Floats y = Floats::load(kSteps.down) + Floats(center_y_ - t.y);
        for (int i = 0; i < 3; ++i) {
            const Floats n =
                mul_add(x, Floats(t.right[i]), mul_add(y, Floats(t.down[i]), Floats(t.at[i])));
            smooth_[i] = select(lanes, n, smooth_[i]);
        }
        constexpr float kReach = kBlockSide - 1;
        const float error = t.error + t.error_right * (std::fabs(center_x_ - t.x) + kReach) +
                            t.error_down * (std::fabs(center_y_ - t.y) + kReach);
        smooth_error_ = select(lanes, Floats(error), smooth_error_);
        smooth_bits_ |= bits_;
    }

    // The error of the direction; of the length 3 u of the square by half, the root's, a product.
    HWY_INLINE void finish_smooth() {
        lanes_ = RayMask::from_bits(smooth_bits_);
        bits_ = smooth_bits_;
        Floats square(0.0F);
        for (const Floats& n : smooth_) square = mul_add(n, n, square);
        const Floats inverse = inverse_sqrt(square);
        const Floats relative = smooth_error_ * inverse;
        const RayMask known = relative < Floats(kSmall);
        Floats normal[3];
        for (int i = 0; i < 3; ++i) normal[i] = smooth_[i] * inverse;
        store_normal(normal, known,
                     mul_add(relative, Floats(kSecondOrder),
                             Floats(roundings(1.5 + 1) + kInverseSqrtError)));
    }

    // Weights V / S and W / S as surface_point() has them. Below 2^-49 of its magnitudes a triple
    // product is noise; where S is 2^29 times that, the weights are within 2^-29.
    void fill_color(const TriangleMesh& mesh, std::uint32_t index) {
        constexpr double kTripleError = 0x1p-49;
        constexpr double kWeightDigits = 0x1p29;
        constexpr double kFullByte = 255;
        const Triangle t = mesh.triangle(index);
        const double scale = scene_.frame().scale;
        const CameraRays& camera = tables_.camera;
        const Vector3 a = (t.a - camera.anchor) * scale;
        const Vector3 from = camera.parallel ? camera.forward : a;
        const Vector3 e1 = (t.b - t.a) * scale;
        const Vector3 e2 = (t.c - t.a) * scale;
        const Vector3 normal = cross(e2, e1);
        const Doubles s =
            camera.parallel ? Doubles(dot(normal, camera.forward)) : plane_function(normal, a);
        const Doubles inverse = precise_reciprocal(s);
        const Doubles x = plane_function(cross(from, e2), a) * inverse;
        const Doubles y = plane_function(cross(e1, from), a) * inverse;
        const double edges = norm1(e1) + norm1(e2);
        const double noise = kTripleError * (norm1(a) + edges + starts_) * edges *
                             static_cast<double>(tables_.rays.longest);
        const RayMask known =
            abs(floats_from(s)) >
            Floats(static_cast<float>(kWeightDigits * noise) + std::numeric_limits<float>::min());
        const IndexTriple& corner =
            (mesh.color_triangles.empty() ? mesh.triangles : mesh.color_triangles)[index];
        const Color& c0 = mesh.colors[corner[0]];
        const Color c1 = mesh.colors[corner[1]] - c0;
        const Color c2 = mesh.colors[corner[2]] - c0;
        for (int c = 0; c < 3; ++c) {
            const Doubles color =
                mul_add(x, Doubles(c1[c] * kFullByte),
                        mul_add(y, Doubles(c2[c] * kFullByte), Doubles(c0[c] * kFullByte)));
            floats_from(color).store(scratch_.color[c] + first_, lanes_);
        }
        give_up(without(lanes_, known));
        scratch_.colored[block_] = static_cast<std::uint16_t>(scratch_.colored[block_] | bits_);
    }

    const ShadingTables& tables_;
    const FastScene& scene_;
    Tile& tile_;
    ShadingScratch& scratch_;
    int first_;
    const BlockDirections& directions_;
    int block_;
    RayMask lanes_;
    std::uint32_t bits_ = 0;

    // X and Y of the block's first lane.
    float center_x_;
    float center_y_;
    Vector3 first_direction_;
    Vector3 first_offset_;
    double starts_;
    Floats smooth_[3];
    Floats smooth_error_;
    std::uint32_t smooth_bits_ = 0;

    std::optional<Rays> rays_;
};

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // NUVO_RENDER_FAST_SMOOTH_NORMALS_H_
