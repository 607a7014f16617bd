#pragma once

#include <vector>

#include "nuvo/math/ray.h"
#include "nuvo/octree/octree.h"
#include "nuvo/scene/scene.h"
#include "random.h"

/// Where the hard rays start and what they are aimed at; at any scale and place.
namespace nuvo::hard {

/// Makes the rays of one batch.
class Aims {
  public:
    Aims(const Scene& scene, const Octree& octree, Random& random);

    /// The ray from one point towards another, as the input may hold it.
    Ray from_to(const Point3& from, const Point3& to) const;
    Ray at_feature(const Point3& from) { return from_to(from, feature()); }

    /// A point at 2 to 4 half widths from the scene's middle; far: up to `factor` times that.
    Point3 outside(double factor = 1);
    /// A point of a random object at which tests are hard: a corner, on an edge, on a sphere.
    Point3 feature();
    Point3 feature(const Object& object);
    /// Somewhere on a surface, up to rounding.
    Point3 on_surface(const Object& object);
    const Object& object();
    /// The middle of an object's box, and the largest half width of it.
    static Point3 middle(const Object& object);
    static double half_size(const Object& object);

    /// A ray whose line passes (1 + offset) R from the centre of a sphere (an ellipsoid in its own
    /// space).
    Ray grazing(const Object& object, const Point3& from, double offset);
    /// Parallel to an axis, its zeros of either sign, through `p`.
    Ray parallel_to_axis(const Point3& p);
    /// In the octree's planes: along voxel edges, within faces, through corners, on diagonals.
    Ray in_split_plane();

  private:
    Point3 voxel_corner();

    const Scene& scene_;
    const Octree& octree_;
    Random& random_;
    Point3 middle_;
    double half_ = 1;
};

}  // namespace nuvo::hard
