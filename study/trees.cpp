#include "trees.h"

#include <algorithm>

#include "nuvo/geometry/overlap.h"
#include "nuvo/octree/walk.h"

namespace nuvo::study {
namespace {

// As in src/render/render.cpp.
constexpr std::size_t kReferencesPerItem = 4;
constexpr std::size_t kReferencesOfSmallScenes = 1 << 20;

/// Trees that are pruned afterwards are cut as if steps were so much cheaper.
constexpr double kCutFurther = 0.25;

MidpointStrategy or_center(MidpointStrategy strategy) {
    return [strategy = std::move(strategy)](const SplitQuery& query) {
        const std::optional<Point3> planes = strategy(query);
        return planes ? planes : spatial_midpoint(query);
    };
}

}  // namespace

CalibratedCosts costs_of(const Primitives& primitives, double step) {
    if (primitives.item_count() == 0) return {step};
    return {step * static_cast<double>(primitives.item_count()) /
            static_cast<double>(primitives.sources.size())};
}

OverlapTest overlap_test(const Scene& scene, const Primitives& primitives, LeafContent leaves) {
    if (leaves == LeafContent::kShapes) return {};
    return [&](ItemId id, const Bounds3& box) {
        const PrimitiveSource& source = primitives.sources[id];
        const nuvo::Shape& shape = scene.objects[source.object].shape;
        if (const auto* mesh = std::get_if<TriangleMesh>(&shape))
            return overlaps(mesh->triangle(source.triangle), box);
        if (const auto* sphere = std::get_if<Sphere>(&shape)) return overlaps(*sphere, box);
        return true;
    };
}

double margin_of(const Primitives& primitives, const Bounds3& beside) {
    Bounds3 all = beside;
    for (const Bounds3& box : primitives.item_boxes) all = all.extended(box);
    return all.empty() ? 0 : path_error_bound(all);
}

Octree build_tree(const Scene& scene, const Primitives& primitives, const Method& method,
                  const TreeOptions& options, Evaluations* evaluations) {
    BuildOptions build;
    build.midpoint = method.make(evaluations);
    const CalibratedCosts costs = costs_of(primitives, options.step);
    build.worth = method.prunes ? CalibratedCosts{costs.step * kCutFurther} : costs;
    if (options.thesis_costs) {
        double shapes = kThesisShapesBase;
        for (const Object& object : scene.objects) {
            const auto* mesh = std::get_if<TriangleMesh>(&object.shape);
            shapes += mesh ? kThesisShapesPerTriangle * static_cast<double>(mesh->triangles.size())
                           : kThesisShapesPerSphere;
        }
        build.worth =
            ThesisCosts{shapes, static_cast<double>(scene.lights.size()), primitives.item_count()};
    } else if (options.in_program) {
        build.midpoint = shrinking(build.midpoint);
        build.fallback = shrinking(spatial_midpoint);
    } else {
        build.midpoint = or_center(build.midpoint);
    }
    build.max_references = kReferencesPerItem * primitives.item_count() + kReferencesOfSmallScenes;
    build.overlaps = overlap_test(scene, primitives, options.leaves);
    build.margin = margin_of(primitives);
    Octree octree = build_octree(primitives.item_boxes, build);
    return method.prunes && !options.thesis_costs ? pruned(octree, costs) : std::move(octree);
}

namespace {

class Pruner {
  public:
    Pruner(const Octree& octree, const CalibratedCosts& costs)
        : octree_(octree), costs_(costs.costs()) {
        keep_.assign(octree.nodes().size(), false);
        decide(0);
    }
    Octree result() {
        nodes_.push_back(octree_.root());
        copy(0, 0);
        return Octree(std::move(nodes_), std::move(items_));
    }

  private:
    struct Subtree {
        double cost;
        std::vector<ItemId> items;
    };

    // Marks the cuts to keep; the items of the whole subtree come back sorted.
    Subtree decide(NodeIndex index) {
        const Node& node = octree_.nodes()[index];
        const Vector3 w = node.voxel.bounds.widths();
        const double area = node.voxel.bounds.surface_area();
        if (node.is_leaf()) {
            const auto items = octree_.contents(node);
            const bool never_entered = items.empty() && (w.x == 0 || w.y == 0 || w.z == 0);
            return {never_entered ? 0 : leaf_cost(area, items.size()),
                    {items.begin(), items.end()}};
        }
        Subtree sum{costs_.interior * area, {}};
        for (int digit = 1; digit <= 8; ++digit) {
            const Subtree child = decide(node.child(digit));
            sum.cost += child.cost;
            sum.items.insert(sum.items.end(), child.items.begin(), child.items.end());
        }
        std::ranges::sort(sum.items);
        sum.items.erase(std::unique(sum.items.begin(), sum.items.end()), sum.items.end());
        const double leaf = leaf_cost(area, sum.items.size());
        keep_[index] = sum.cost < leaf;
        sum.cost = std::min(sum.cost, leaf);
        return sum;
    }
    double leaf_cost(double area, std::size_t items) const {
        return area * (costs_.leaf + costs_.object * static_cast<double>(items));
    }

    void copy(NodeIndex from, NodeIndex to) {
        const Node& node = octree_.nodes()[from];
        if (keep_[from]) {
            const auto first = static_cast<NodeIndex>(nodes_.size());
            nodes_[to].first_child = first;
            for (int digit = 1; digit <= 8; ++digit)
                nodes_.push_back(octree_.nodes()[node.child(digit)]);
            for (int digit = 1; digit <= 8; ++digit)
                copy(node.child(digit), first + static_cast<NodeIndex>(digit - 1));
            return;
        }
        std::vector<ItemId> items;
        collect(from, items);
        std::ranges::sort(items);
        items.erase(std::unique(items.begin(), items.end()), items.end());
        nodes_[to].first_child = 0;
        nodes_[to].first_item = static_cast<std::uint32_t>(items_.size());
        nodes_[to].item_count = static_cast<std::uint32_t>(items.size());
        items_.insert(items_.end(), items.begin(), items.end());
    }
    void collect(NodeIndex index, std::vector<ItemId>& items) const {
        const Node& node = octree_.nodes()[index];
        if (node.is_leaf()) {
            const auto own = octree_.contents(node);
            items.insert(items.end(), own.begin(), own.end());
            return;
        }
        for (int digit = 1; digit <= 8; ++digit) collect(node.child(digit), items);
    }

    const Octree& octree_;
    SahCosts costs_;
    std::vector<bool> keep_;
    std::vector<Node> nodes_;
    std::vector<ItemId> items_;
};

}  // namespace

Octree pruned(const Octree& octree, const CalibratedCosts& costs) {
    return Pruner(octree, costs).result();
}

}  // namespace nuvo::study
