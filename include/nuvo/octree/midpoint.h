#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "nuvo/octree/voxel.h"

namespace nuvo {

/// What a strategy may know about the voxel it is to cut.
struct SplitQuery {
    const Voxel& voxel;              ///< midpoint: its spatial centre
    std::span<const Bounds3> boxes;  ///< of the items in it, whole and already inflated
    double margin = 0;               ///< by how much they are inflated, scene units
};

/// Where to cut a voxel; none: not at all.
using MidpointStrategy = std::function<std::optional<Point3>(const SplitQuery&)>;

/// The spatial centre: the uniform octree.
std::optional<Point3> spatial_midpoint(const SplitQuery& query);

/// `strategy`, but for axes where all items that end within the voxel lie in less than a quarter of
/// it: there the plane cuts off the wider of the two sides without them. So a small object on a
/// wide ground is reached by two cuts instead of one for each power of two between their sizes.
MidpointStrategy shrinking(MidpointStrategy strategy);

/// Per axis, the plane of least true-area cost LSA(b) L(b) + RSA(b) R(b) [eq. 11 with objects on
/// the plane counted on both sides], searched over every object edge in the voxel. The plane stands
/// clear of the edge it belongs to, for an object that touched it would lie on both sides.
std::optional<Point3> sweep_midpoint(const SplitQuery& query);

/// The published program's search, in float: NLopt's MLSL (low-discrepancy) with Sbplx as local
/// search, minimising the sum of eq. 16 between the voxel's midpoint and the mean of the items'
/// centres, in at most 100 evaluations. None where the box between these comes within 0.1 scene
/// units of a face, or is thin and the voxel small. Deterministic. [docs/thesis-map.md, section 7]
std::optional<Point3> published_midpoint(const SplitQuery& query);

/// Median of the box centres on one axis; of an even number the mean of the middle two. [5.4.2]
double object_median(std::span<const Bounds3> boxes, int axis);

/// Object edges of one axis in order: how many boxes lie to either side of a plane.
class AxisEdges {
  public:
    AxisEdges(std::span<const Bounds3> boxes, int axis);

    /// L: boxes that begin below the plane.
    std::size_t left_of(double plane) const;
    /// R: boxes that end above the plane.
    std::size_t right_of(double plane) const;
    std::span<const double> begins() const { return begins_; }
    std::span<const double> ends() const { return ends_; }

  private:
    std::vector<double> begins_;
    std::vector<double> ends_;
};

/// The thesis' midpoint score, per axis b L(b) + (1 - b) R(b) with b the plane's place in the voxel
/// from 0 to 1.
class MidpointScore {
  public:
    explicit MidpointScore(const SplitQuery& query);
    /// The product over the axes. [eq. 15, 17, 19]
    double product(const Point3& midpoint) const;
    /// The sum over the axes, b in scene units: what the published program minimises. [eq. 16]
    double sum(const Point3& midpoint) const;

  private:
    double of_axis(int axis, double plane, double below, double whole) const;

    Bounds3 voxel_;
    Vector3 widths_;
    AxisEdges edges_[3];
};

}  // namespace nuvo
