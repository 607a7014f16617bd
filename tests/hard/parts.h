#pragma once

#include "nuvo/scene/scene.h"
#include "random.h"

/// What the hard scenes are made of.
namespace nuvo::hard {

/// A closed mesh around the origin, seen whole from every point within 0.5 of it: an octahedron
/// whose faces were cut in four `level` times, corners at a distance of 1 - roughness .. 1 +
/// roughness (< 0.3).
TriangleMesh closed_mesh(Random& random, int level, double roughness);
/// The six sides of a closed box as 12 triangles.
TriangleMesh box_mesh(const Point3& low, const Point3& high);
/// One triangle.
TriangleMesh single(const Point3& a, const Point3& b, const Point3& c);
/// Every corner through `linear`, then moved, then held as the input may hold it.
TriangleMesh placed(TriangleMesh mesh, const Random& random, const Matrix3& linear,
                    const Vector3& move);
/// A diagonal matrix.
Matrix3 scaling(const Vector3& factors);
/// A linear map that is no similarity: scaled, sheared, mirrored, turned; some nearly flat.
Matrix3 distortion(Random& random);

/// Adds the shape with its place in document order, both of its sides visible.
void add(Scene& scene, Shape shape);
/// All coordinates times `scale`, then moved, then held as the input may hold them.
void place(Scene& scene, const Random& random, double scale, const Vector3& move);

/// A bit of everything within 8 of the origin: `count` objects.
Scene mixed_scene(Random& random, int count);
/// Octahedra and spheres on integer points, so that faces, edges, corners and diagonals coincide.
Scene lattice_scene(Random& random);

}  // namespace nuvo::hard
