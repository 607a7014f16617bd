#pragma once

#include <cstddef>
#include <cstdint>

#include "nuvo/geometry/sphere.h"
#include "nuvo/math/ray.h"
#include "nuvo/render/fast.h"

// Whether and where rays meet triangles and spheres, many pairs at a time: the first stage of the
// exact predicates (predicates_triangle.cpp) in vectors of doubles. It leaves open what that stage
// leaves to the wider ones. Root::t is that stage's to the last bit, for it is computed operation
// by operation.

namespace nuvo {

/// Pairs of a ray and a triangle, or of a ray and a sphere, side by side.
struct alignas(64) PairRoots {
    static constexpr std::size_t kCount = 32;

    double a[3][kCount];  ///< a corner; of a sphere the center
    double b[3][kCount];  ///< of a sphere b[0] is the radius
    double c[3][kCount];
    double origin[3][kCount];
    double direction[3][kCount];
    double t[kCount];  ///< Root::t where `found`
    // One bit each:
    std::uint32_t front_only = 0;  ///< of the triangle the back is invisible
    std::uint32_t found;           ///< the plane is met at a t > 0 that is known
    std::uint32_t hit;             ///< `found`, and surely within the triangle
    std::uint32_t missed;          ///< surely not met at a t > 0
    bool only_roots = false;       ///< the line is known to meet the triangles: `found` alone

    void set(std::size_t i, const Ray& ray, const Point3& at, const Point3& bt, const Point3& ct) {
        for (int axis = 0; axis < 3; ++axis) {
            b[axis][i] = bt[axis];
            c[axis][i] = ct[axis];
        }
        set(i, ray, at);
    }
    void set(std::size_t i, const Ray& ray, const Sphere& sphere) {
        b[0][i] = sphere.radius;
        set(i, ray, sphere.center);
    }
    void set_front_only(std::size_t i, bool so) {
        const std::uint32_t bit = std::uint32_t{1} << i;
        front_only = so ? front_only | bit : front_only & ~bit;
    }

  private:
    void set(std::size_t i, const Ray& ray, const Point3& at) {
        for (int axis = 0; axis < 3; ++axis) {
            a[axis][i] = at[axis];
            origin[axis][i] = ray.origin[axis];
            direction[axis][i] = ray.direction[axis];
        }
    }
};

/// Fills in the answers to the first `count`.
class PairRootStage {
  public:
    explicit PairRootStage(InstructionSet isa);
    void find_triangles(PairRoots& roots, std::size_t count) const { triangles_(roots, count); }
    /// `found` alone, of spheres that are known to be hit.
    void find_spheres(PairRoots& roots, std::size_t count) const { spheres_(roots, count); }

  private:
    void (*triangles_)(PairRoots&, std::size_t);
    void (*spheres_)(PairRoots&, std::size_t);
};

}  // namespace nuvo
