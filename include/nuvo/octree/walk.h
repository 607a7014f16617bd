#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "nuvo/math/error_bounds.h"
#include "nuvo/octree/octree.h"

namespace nuvo {

/// Finds children through the hash map of names, as Glassner does. [thesis 4.4.4, 5.4]
struct HashLocator {
    static NodeIndex child(const Octree& octree, NodeIndex parent, int digit) {
        return octree.names().find(child_label(octree.nodes()[parent].label, digit))->second;
    }
};

/// Finds children through the array of nodes.
struct DescentLocator {
    static NodeIndex child(const Octree& octree, NodeIndex parent, int digit) {
        return octree.nodes()[parent].child(digit);
    }
};

/// Bound on how far, on any axis, the walk's computed path strays from the ray inside `root`: the
/// margin by which items must be listed beyond their own extent. Derived in docs/numerics.md.
double path_error_bound(const Bounds3& root);

namespace detail {

/// Where a ray enters a box: t >= 0 and the axis of the face; -1: it starts within all slabs.
struct Entry {
    double t;
    int axis;

    /// A t surely no later.
    double before() const { return t * (1 - 8 * kUnitRoundoff); }
};

/// Conservative: none only when the ray surely passes the box.
inline std::optional<Entry> slab_entry(const Ray& ray, const Bounds3& box) {
    Entry entry{0, -1};
    double exit = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
        const double o = ray.origin[axis];
        const double d = ray.direction[axis];
        if (d == 0) {
            if (o < box.min[axis] || o > box.max[axis]) return std::nullopt;
            continue;
        }
        const double near = ((d > 0 ? box.min : box.max)[axis] - o) / d;
        if (near > entry.t) entry = {near, axis};
        exit = std::min(exit, ((d > 0 ? box.max : box.min)[axis] - o) / d);
    }
    if (!(entry.t <= exit + 8 * kUnitRoundoff * (entry.t + std::fabs(exit)))) return std::nullopt;
    return entry;
}

inline double size_of(const Bounds3& root) {
    return std::fmax(max_norm(root.min), max_norm(root.max));
}

/// Further out than the path's error allows an origin of the walk to be.
inline bool is_far(const Point3& point, const Bounds3& root) {
    return max_norm(point) > 2 * size_of(root);
}

/// Of such sizes no t of the walk overflows, or is subnormal to any effect. [numerics: the walk]
inline bool is_ordinary(double size) { return size > 0x1p-400 && size < 0x1p400; }
inline bool is_ordinary(const Ray& ray) {
    return is_ordinary(max_norm(ray.direction)) && max_norm(ray.origin) < 0x1p400;
}
/// Scales a direction of any size by a power of two so that the same holds of it inside the root;
/// returns the exponent.
int scale_direction(const Bounds3& root, Vector3& direction);

/// For a ray from outside of the root and from any distance: decides in exact arithmetic whether it
/// meets the root, rounds the point where it enters, and bounds that point's t from below.
bool enter_exactly(const Ray& ray, const Bounds3& root, Point3& entry, double& t);

}  // namespace detail

/// Glassner's walk without an epsilon: visits the leaves that the ray meets at 0 < t < t_end, in
/// order, each once. `visit(leaf, exit)` gets the leaf and a lower bound of the t at which the ray
/// leaves it, and returns true to end the walk. The state is a point that sits exactly on the
/// stored face it crosses, so the walk always ends and needs no smallest voxel.
template <typename Locator>
class ExactWalk {
  public:
    explicit ExactWalk(const Octree& octree)
        : octree_(octree),
          nodes_(octree.nodes()),
          ordinary_size_(detail::is_ordinary(detail::size_of(octree.root().voxel.bounds))) {}

    template <typename Visit>
    void operator()(const Ray& ray, double t_end, Visit&& visit) {
        direction_ = ray.direction;
        shift_ = 0;
        const bool ordinary = ordinary_size_ && detail::is_ordinary(ray);
        if (!ordinary) shift_ = detail::scale_direction(nodes_[0].voxel.bounds, direction_);
        if (!enter(ray, ordinary)) return;
        path_[0] = 0;
        level_ = 0;
        for (;;) {
            descend();
            const Node& leaf = nodes_[path_[level_]];
            const Bounds3& box = leaf.voxel.bounds;
            const auto [axis, t] = exit_of(box);
            const double exit = lower_bound_of(t);
            if (visit(leaf, exit) || exit >= t_end || axis < 0) return;
            cross(box, axis, t);
            if (!climb()) return;
        }
    }

  private:
    struct Exit {
        int axis;
        double t;
    };

    double heading_face(const Bounds3& box, int axis) const {
        return direction_[axis] > 0 ? box.max[axis] : box.min[axis];
    }

    // Moves the origin to where the ray enters the root: first to a point of the ray just before
    // it, correctly rounded by the fused operations, so that a distant origin costs no accuracy;
    // then, from there, exactly onto the face.
    bool enter(const Ray& ray, bool ordinary) {
        const Bounds3& root = nodes_[0].voxel.bounds;
        base_ = 0;
        position_ = origin_ = ray.origin;
        if (root.contains(origin_)) return true;
        if (!ordinary) return enter_exactly(ray);
        std::optional<detail::Entry> entry = detail::slab_entry(ray, root);
        if (!entry) return false;
        base_ = entry->before();
        origin_ = {std::fma(base_, direction_.x, origin_.x),
                   std::fma(base_, direction_.y, origin_.y),
                   std::fma(base_, direction_.z, origin_.z)};
        if (detail::is_far(origin_, root)) return enter_exactly(ray);
        position_ = origin_;
        if (root.contains(origin_)) return true;
        entry = detail::slab_entry({origin_, direction_}, root);
        if (!entry) return false;
        for (int k = 0; k < 3; ++k)
            position_[k] =
                std::clamp(origin_[k] + entry->t * direction_[k], root.min[k], root.max[k]);
        const int axis = entry->axis;
        if (axis >= 0) position_[axis] = direction_[axis] > 0 ? root.min[axis] : root.max[axis];
        return true;
    }
    bool enter_exactly(const Ray& ray) {
        if (!detail::enter_exactly(ray, nodes_[0].voxel.bounds, origin_, base_)) return false;
        position_ = origin_;
        return true;
    }

    // From the path's last node down to the leaf that the ray is in at, or just after, position_:
    // on a midpoint's plane the side it is heading for.
    void descend() {
        while (!nodes_[path_[level_]].is_leaf()) {
            const NodeIndex parent = path_[level_];
            const Point3& mid = nodes_[parent].voxel.midpoint;
            const int bits =
                (upper(0, mid.x) ? 1 : 0) | (upper(1, mid.y) ? 2 : 0) | (upper(2, mid.z) ? 4 : 0);
            path_[++level_] = Locator::child(octree_, parent, octant_digit(bits));
        }
    }
    bool upper(int axis, double plane) const {
        return direction_[axis] < 0 ? position_[axis] > plane : position_[axis] >= plane;
    }

    Exit exit_of(const Bounds3& box) const {
        Exit exit{-1, kInfinity};
        for (int axis = 0; axis < 3; ++axis) {
            if (direction_[axis] == 0) continue;
            const double t = (heading_face(box, axis) - origin_[axis]) / direction_[axis];
            if (exit.axis < 0 || t < exit.t) exit = {axis, t};
        }
        return exit;
    }

    // Of a t of the walk, on the ray itself.
    double lower_bound_of(double t) const {
        if (shift_ != 0 && t != kInfinity)
            t = std::min(std::ldexp(t, shift_), std::numeric_limits<double>::max() / 2);
        return (base_ + t) - 8 * kUnitRoundoff * (base_ + std::fabs(t)) - 4 * kUnderflow;
    }

    // Onto the face that is left; the other axes follow the ray without ever going back.
    void cross(const Bounds3& box, int exit_axis, double t) {
        for (int k = 0; k < 3; ++k) {
            const double d = direction_[k];
            if (d == 0) continue;
            if (k == exit_axis) {
                position_[k] = heading_face(box, k);
            } else {
                const double next = origin_[k] + t * d;
                position_[k] = d > 0 ? std::clamp(next, position_[k], box.max[k])
                                     : std::clamp(next, box.min[k], position_[k]);
            }
        }
    }

    // Up to the lowest ancestor that position_ has not left; false when it has left the root.
    bool climb() {
        for (; level_ >= 0; --level_) {
            const Bounds3& box = nodes_[path_[level_]].voxel.bounds;
            if (inside(0, box) && inside(1, box) && inside(2, box)) return true;
        }
        return false;
    }
    bool inside(int axis, const Bounds3& box) const {
        const double d = direction_[axis];
        return d > 0   ? position_[axis] < box.max[axis]
               : d < 0 ? position_[axis] > box.min[axis]
                       : true;
    }

    const Octree& octree_;
    std::span<const Node> nodes_;
    bool ordinary_size_;
    Vector3 direction_;  // the ray's times 2^shift_
    int shift_ = 0;
    Point3 origin_;    // of the walk: the ray's own, or its entry into the root
    double base_ = 0;  // at most the t of the walk's origin on the ray
    Point3 position_;
    std::array<NodeIndex, kMaxLabelDigits + 1> path_{};  // from the root to the current node
    int level_ = 0;
};

/// Where a walk begins: a ray that comes from anywhere searches its first leaf from the root; one
/// that leaves a surface starts, without a search, in the leaf that its origin belongs to.
/// [thesis 5.3.2]
enum class WalkStart { kRoot, kLeaf };

/// The published program's epsilon, in scene units, for what reproduces that program: a face this
/// near counts as behind the ray, and a hit this far out of a leaf as in it. It bounds no error;
/// the exact walk and tests have none. [thesis 5.5]
inline constexpr double kPublishedEpsilon = 1e-5;

/// The published walk: a point is pushed past each face by `step` times the smallest voxel width.
/// `visit(leaf)` returns true to end the walk. Leaves can be missed, and the walk gives up where
/// the pushed point makes no headway. [thesis 4.4.4, 5.4.3]
template <typename T, typename Locator>
class NudgedWalk {
  public:
    NudgedWalk(const Octree& octree, double step)
        : octree_(octree), push_(static_cast<T>(step * octree.smallest_width())) {}

    /// `on_search` is called for each search of a next leaf, in vain or not.
    template <typename OnSearch, typename Visit>
    void operator()(const RayT<T>& ray, WalkStart start, OnSearch&& on_search,
                    Visit&& visit) const {
        const Node& root = octree_.root();
        // How far along the ray the walk has come. Where the way to the far face does not grow, the
        // ray is in the same leaf again or goes to and fro between two: the endless loop of thesis
        // 5.4.2, cut short.
        T reached = -std::numeric_limits<T>::infinity();
        std::optional<NodeIndex> leaf;
        if (start == WalkStart::kLeaf || bounds_of(root).contains(ray.origin)) {
            leaf = find(ray.origin);
        } else if (!root.is_leaf()) {
            on_search();
            leaf = next(root, ray, reached);
        } else if (crossings(bounds_of(root), ray).hit()) {
            leaf = 0;
        }
        while (leaf) {
            const Node& node = octree_.nodes()[*leaf];
            if (visit(node)) return;
            on_search();
            leaf = next(node, ray, reached);
        }
    }

    static Bounds3T<T> bounds_of(const Node& node) {
        return {Vec3<T>(node.voxel.bounds.min), Vec3<T>(node.voxel.bounds.max)};
    }

  private:
    struct Crossings {
        T near;
        T far;
        bool hit() const { return near < far && far > static_cast<T>(kPublishedEpsilon); }
    };

    // A voxel search: the leaf after `node`, or the first one where `node` is cut.
    std::optional<NodeIndex> next(const Node& node, const RayT<T>& ray, T& reached) const {
        const Crossings c = crossings(bounds_of(node), ray);
        if (!c.hit()) return std::nullopt;
        if (node.is_leaf()) {
            if (!(c.far > reached)) return std::nullopt;
            reached = c.far;
        }
        const Vec3<T> push = ray.direction * (push_ / length(ray.direction));
        const Vec3<T> p = ray.at(node.is_leaf() ? c.far : c.near) + push;
        if (!bounds_of(octree_.root()).contains(p)) return std::nullopt;
        return find(p);
    }

    static Crossings crossings(const Bounds3T<T>& box, const RayT<T>& ray) {
        Crossings c{-std::numeric_limits<T>::infinity(), std::numeric_limits<T>::infinity()};
        for (int axis = 0; axis < 3; ++axis) {
            const T o = ray.origin[axis];
            const T d = ray.direction[axis];
            if (d == 0) {
                if (o < box.min[axis] || box.max[axis] < o) return {T(1), T(0)};
                continue;
            }
            const T t0 = (box.min[axis] - o) / d;
            const T t1 = (box.max[axis] - o) / d;
            c.near = std::max(c.near, std::min(t0, t1));
            c.far = std::min(c.far, std::max(t0, t1));
        }
        return c;
    }

    // The leaf that p belongs to; outside the root, the one that p is nearest by its octants.
    NodeIndex find(const Vec3<T>& p) const {
        const Point3 point(p);
        NodeIndex index = 0;
        while (!octree_.nodes()[index].is_leaf())
            index = Locator::child(octree_, index, octree_.nodes()[index].voxel.octant_of(point));
        return index;
    }

    const Octree& octree_;
    T push_;
};

}  // namespace nuvo
