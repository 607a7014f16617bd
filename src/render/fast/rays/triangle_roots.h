#pragma once

#include <cstddef>
#include <cstdint>

#include "nuvo/geometry/triangle_mesh.h"
#include "nuvo/math/ray.h"
#include "nuvo/render/fast.h"

// Where rays meet triangles that they are known to meet: Root::t of the exact predicates, many at a
// time. It is the first stage of hit() (predicates_triangle.cpp) in vectors of doubles, operation
// by operation, and leaves open what that stage leaves to the wider ones.

namespace nuvo {

/// Rays and triangles side by side.
struct alignas(64) TriangleRoots {
    static constexpr std::size_t kCount = 32;

    double a[3][kCount];  ///< a corner
    double b[3][kCount];
    double c[3][kCount];
    double origin[3][kCount];
    double direction[3][kCount];
    double t[kCount];  ///< Root::t where `found`
    std::uint32_t found;

    void set(std::size_t i, const Ray& ray, const Point3& at, const Point3& bt, const Point3& ct) {
        for (int axis = 0; axis < 3; ++axis) {
            a[axis][i] = at[axis];
            b[axis][i] = bt[axis];
            c[axis][i] = ct[axis];
            origin[axis][i] = ray.origin[axis];
            direction[axis][i] = ray.direction[axis];
        }
    }
};

/// Fills in t and `found` of the first `count`.
class TriangleRootStage {
  public:
    explicit TriangleRootStage(InstructionSet isa);
    void find(TriangleRoots& roots, std::size_t count) const { find_(roots, count); }

  private:
    void (*find_)(TriangleRoots&, std::size_t);
};

}  // namespace nuvo
