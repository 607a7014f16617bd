#include "nuvo/render/render.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "chosen.h"
#include "nuvo/geometry/overlap.h"
#include "nuvo/math/error_bounds.h"
#include "nuvo/octree/build.h"
#include "nuvo/octree/walk.h"
#include "nuvo/render/sah_prices.h"
#include "tracer.h"

namespace nuvo {
namespace {

// The octree may hold so many references: see docs/performance.md, "The octree's budget".
constexpr std::size_t kReferencesPerItem = 4;
constexpr std::size_t kReferencesOfSmallScenes = 1 << 14;
constexpr std::size_t kMoreReferencesPerItem = 60;
constexpr std::size_t kMostMoreReferences = 1 << 20;

std::size_t reference_budget(std::size_t items) {
    return kReferencesPerItem * items +
           std::min(kReferencesOfSmallScenes + kMoreReferencesPerItem * items, kMostMoreReferences);
}

ThesisCosts thesis_costs(const Scene& scene, const Primitives& primitives) {
    double shapes = kThesisShapesBase;
    for (const Object& object : scene.objects) {
        const auto* mesh = std::get_if<TriangleMesh>(&object.shape);
        shapes += mesh ? kThesisShapesPerTriangle * static_cast<double>(mesh->triangles.size())
                       : kThesisShapesPerSphere;
    }
    return {shapes, static_cast<double>(scene.lights.size()), primitives.item_count()};
}

// In tests of a leaf item: a whole shape takes as many as it has primitives, on average.
CalibratedCosts calibrated_costs(const Primitives& primitives) {
    CalibratedCosts costs;
    if (primitives.item_count() > 0)
        costs.step *= static_cast<double>(primitives.item_count()) /
                      static_cast<double>(primitives.sources.size());
    return costs;
}

// Rounded to float. g++ 12 leaves the rounding out where several numbers go to float and back side
// by side, unless something stands between.
Point3 in_float(const Point3& p) {
    const volatile float x = static_cast<float>(p.x);
    const volatile float y = static_cast<float>(p.y);
    const volatile float z = static_cast<float>(p.z);
    return {x, y, z};
}

// The published program's box of a mesh: around the mean of its vertices, as far to either side as
// the furthest of them.
Bounds3 box_around_mean(const TriangleMesh& mesh) {
    Vec3<float> sum;
    for (const Point3& p : mesh.positions) sum += Vec3<float>(p);
    const Vec3<float> mean = sum / static_cast<float>(mesh.positions.size());
    Vec3<float> reach;
    for (const Point3& p : mesh.positions)
        for (int axis = 0; axis < 3; ++axis)
            reach[axis] =
                std::max(reach[axis], std::fabs(static_cast<float>(p[axis]) - mean[axis]));
    return {Point3(mean - reach), Point3(mean + reach)};
}

// The boxes that the published program places by, in its arithmetic.
std::vector<Bounds3> float_boxes(const Scene& scene, const Primitives& primitives,
                                 LeafContent leaves) {
    std::vector<Bounds3> boxes;
    for (std::size_t item = 0; item < primitives.item_count(); ++item) {
        const PrimitiveSource& source = primitives.sources[primitives.of_item(item).first];
        const auto* mesh = std::get_if<TriangleMesh>(&scene.objects[source.object].shape);
        const Bounds3& own = primitives.item_boxes[item];
        boxes.push_back(mesh && leaves == LeafContent::kShapes
                            ? box_around_mean(*mesh)
                            : Bounds3{in_float(own.min), in_float(own.max)});
    }
    return boxes;
}

MidpointStrategy rounded_to_float(MidpointStrategy strategy) {
    return [strategy = std::move(strategy)](const SplitQuery& query) {
        std::optional<Point3> midpoint = strategy(query);
        if (midpoint) *midpoint = in_float(*midpoint);
        return midpoint;
    };
}

MidpointStrategy midpoint_strategy(const Profile& profile) {
    if (profile.type == OctreeType::kUniform) return spatial_midpoint;
    switch (profile.midpoint) {
        case MidpointChoice::kSpatial:
            return spatial_midpoint;
        case MidpointChoice::kSweep:
            return sweep_midpoint;
        case MidpointChoice::kPublished:
            return published_midpoint;
    }
    return spatial_midpoint;
}

// True where item `id`, a single primitive, has surface in the box.
bool primitive_overlaps(const Scene& scene, const PrimitiveSource& source, const Bounds3& box) {
    const Shape& shape = scene.objects[source.object].shape;
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape))
        return overlaps(mesh->triangle(source.triangle), box);
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return overlaps(*sphere, box);
    return true;  // an ellipsoid is listed by its box, which the builder has tested
}

template <typename Kernel, typename Search>
std::vector<RayAnswer> answers(const Scene& scene, const Kernel& kernel, Search search,
                               std::span<const Ray> rays, Progress* progress) {
    constexpr std::size_t kTold = 1024;
    std::vector<RayAnswer> out;
    out.reserve(rays.size());
    begin(progress, "rays", rays.size());
    for (const Ray& ray : rays) {
        if (out.size() % kTold == kTold - 1) add(progress, kTold);
        const auto hit = search.closest(kernel.prepare(ray));
        RayAnswer answer;
        answer.t = kInfinity;
        if (hit) {
            const PrimitiveSource& source = kernel.source(hit->primitive);
            answer = {true, scene.objects[source.object].shape_index, source.triangle,
                      static_cast<double>(kernel.t(*hit))};
        }
        out.push_back(answer);
    }
    return out;
}

// What happens to lights beyond the bits of PixelFacts::lit: a mixing of all bits (splitmix64).
std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    return x ^ (x >> 31);
}

// Writes down what it is told.
struct FactsObserver {
    PixelFacts& facts;
    template <typename Hit>
    void hit(const Hit& hit) {
        facts.primitive = hit.primitive;
    }
    template <typename Surface>
    void asks(const Surface&, std::size_t) {}
    void lit(std::size_t light) {
        facts.lit ^= light < 64 ? std::uint64_t{1} << light : mixed(light);
    }
};

}  // namespace

Octree build_tree(const Scene& scene, const Primitives& primitives, const Profile& profile,
                  Progress* progress) {
    BuildOptions options;
    options.progress = progress;
    options.midpoint = midpoint_strategy(profile);
    std::span<const Bounds3> boxes(primitives.item_boxes);
    std::vector<Bounds3> published_boxes;
    if (profile.costs == CostChoice::kThesis && !profile.max_objects) {
        options.worth = thesis_costs(scene, primitives);
        if (profile.step) {
            options.strict_placement = true;
            options.midpoint = rounded_to_float(std::move(options.midpoint));
            published_boxes = float_boxes(scene, primitives, profile.leaves);
            boxes = published_boxes;
        }
    } else {
        options.worth = calibrated_costs(primitives);
        options.midpoint = shrinking(options.midpoint);
        options.fallback = shrinking(spatial_midpoint);
        options.max_references = reference_budget(primitives.item_count());
    }
    if (profile.max_objects) options.worth = MaxObjects{*profile.max_objects};
    if (profile.leaves == LeafContent::kPrimitives)
        options.overlaps = [&](ItemId id, const Bounds3& box) {
            return primitive_overlaps(scene, primitives.sources[id], box);
        };
    if (!profile.step) {
        Bounds3 all;
        for (const Bounds3& box : primitives.item_boxes) all = all.extended(box);
        if (!all.empty()) options.margin = path_error_bound(all);
    }
    Octree octree = build_octree(boxes, options);
    if (profile.walk == WalkChoice::kHash) octree.make_names();
    return octree;
}

SahCosts sah_prices(const Scene& scene, const Primitives& primitives, const Profile& profile,
                    std::size_t leaves) {
    return profile.costs == CostChoice::kThesis && !profile.max_objects
               ? thesis_costs(scene, primitives)(leaves)
               : calibrated_costs(primitives).costs();
}

std::size_t tracer_bytes(const Scene& scene, const Primitives& primitives, const Profile& profile) {
    return with_kernel(scene, primitives, profile,
                       [](const auto& kernel) { return kernel.memory_bytes(); });
}

Image render(const Scene& scene, const Primitives& primitives, const Octree& octree,
             const Profile& profile, Resolution resolution, Progress* progress) {
    return with_kernel(scene, primitives, profile, [&](const auto& kernel) {
        return with_search(kernel, primitives, octree, profile, NoCounter{}, [&](auto search) {
            return Tracer(scene, kernel, std::move(search)).image(resolution, progress);
        });
    });
}

Image render_brute_force(const Scene& scene, const Primitives& primitives, const Profile& profile,
                         Resolution resolution, Progress* progress) {
    return with_kernel(scene, primitives, profile, [&](const auto& kernel) {
        return Tracer(scene, kernel, BruteForceSearch(kernel, primitives))
            .image(resolution, progress);
    });
}

std::vector<PixelFacts> render_facts(const Scene& scene, const Primitives& primitives,
                                     const Octree& octree, const Profile& profile,
                                     Resolution resolution, Progress* progress) {
    std::vector<PixelFacts> facts;
    begin(progress, "pixels", pixel_count(resolution));
    const RayGenerator rays(scene.camera, resolution);
    with_kernel(scene, primitives, profile, [&](const auto& kernel) {
        with_search(kernel, primitives, octree, profile, NoCounter{}, [&](auto search) {
            Tracer tracer(scene, kernel, std::move(search));
            for (int y = 0; y < resolution.height; ++y) {
                for (int x = 0; x < resolution.width; ++x)
                    tracer.color(rays.ray(x, y), FactsObserver{facts.emplace_back()});
                add(progress, static_cast<std::uint64_t>(resolution.width));
            }
        });
    });
    return facts;
}

std::vector<RayAnswer> closest_hits(const Scene& scene, const Primitives& primitives,
                                    const Octree* octree, const Profile& profile,
                                    std::span<const Ray> rays, Progress* progress) {
    return with_kernel(scene, primitives, profile, [&](const auto& kernel) {
        if (!octree)
            return answers(scene, kernel, BruteForceSearch(kernel, primitives), rays, progress);
        return with_search(kernel, primitives, *octree, profile, NoCounter{}, [&](auto search) {
            return answers(scene, kernel, std::move(search), rays, progress);
        });
    });
}

}  // namespace nuvo
