#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>
#include <optional>
#include <vector>

#include "nuvo/math/ray.h"
#include "nuvo/scene/scene.h"
#include "sieve.h"

/// The definitions of docs/numerics.md by brute force in integers and 100-digit roots, sharing
/// nothing with the program but the types of the scene.
namespace nuvo::hard {

namespace mp = boost::multiprecision;
/// Rationals are kept as pairs of these: doubles are integers on a grid of a power of two.
using Integer = mp::number<
    mp::cpp_int_backend<512, 0, mp::signed_magnitude, mp::unchecked, std::allocator<mp::limb_type>>,
    mp::et_off>;
using Real = mp::number<mp::cpp_bin_float<100>, mp::et_off>;

/// Where a ray meets a primitive first, at t > 0. On the ray's grid: t is a power of two times
/// this.
struct OracleRoot {
    bool rational = false;
    Integer numerator;  ///< rational: t = numerator / denominator, denominator > 0
    Integer denominator = 1;
    Integer a, b, c;  ///< otherwise a root of a t^2 + 2 b t + c, the larger one if c <= 0
    /// The line passes within 1e-6 R of the sphere's silhouette (in the ellipsoid's own space).
    bool near_tangency = false;

    /// Its first 100 digits.
    const Real& value() const;

  private:
    mutable std::optional<Real> value_;  ///< once it was asked for
};

/// The exact sign of a - b.
int compare(const OracleRoot& a, const OracleRoot& b);

/// What one ray hits: all of Scene::objects[object]'s triangle, and t.
struct OracleAnswer {
    std::size_t object = 0;
    std::size_t triangle = 0;
    OracleRoot root;
};

/// A ray on integer grids.
struct OracleRay {
    OracleRay(const Ray& ray, int scene_grid);
    /// t of the ray from a root on its grid.
    Real t(const OracleRoot& root) const { return ldexp(root.value(), grid - direction_grid); }

    Ray ray;
    int grid;  ///< positions are multiples of 2^grid
    int direction_grid;
    Vec3<Integer> origin;
    Vec3<Integer> direction;
};

class Oracle {
  public:
    /// `scene` outlives the oracle.
    explicit Oracle(const Scene& scene);

    OracleRay prepare(const Ray& ray) const { return OracleRay(ray, grid_); }
    /// The nearest hit; of equal t the first in document order.
    std::optional<OracleAnswer> closest(const OracleRay& ray) const;
    /// One primitive alone; none: it is not hit.
    std::optional<OracleRoot> root(const OracleRay& ray, std::size_t object,
                                   std::size_t triangle) const;

  private:
    const Scene& scene_;
    int grid_;
    Sieve sieve_;
};

}  // namespace nuvo::hard
