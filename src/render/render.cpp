#include "nuvo/render/render.h"

#include <limits>
#include <type_traits>

#include "exact_kernel.h"
#include "nuvo/geometry/overlap.h"
#include "nuvo/octree/build.h"
#include "nuvo/octree/walk.h"
#include "plain_kernel.h"
#include "search.h"
#include "tracer.h"

namespace nuvo {
namespace {

// The cap of the published program, its "smallest voxel": it counts levels, the root's included.
constexpr int kThesisMaxDepth = 9;
// The octree may hold so many references: see docs/performance.md, "The octree's budget".
constexpr std::size_t kReferencesPerItem = 4;
constexpr std::size_t kReferencesOfSmallScenes = 1 << 20;
// Triangles of the octahedra by which `thesis_weight` is stated.
constexpr double kTrianglesOfReference = 8;

// The thesis' numShapes: spheres count 1, triangles thesis_weight / 8.
double weighted_shapes(const Scene& scene, double thesis_weight) {
    double shapes = 0;
    for (const Object& object : scene.objects) {
        const auto* mesh = std::get_if<TriangleMesh>(&object.shape);
        shapes += mesh ? static_cast<double>(mesh->triangles.size()) * thesis_weight /
                             kTrianglesOfReference
                       : 1;
    }
    return shapes;
}

MidpointStrategy midpoint_strategy(const Profile& profile) {
    if (profile.type == OctreeType::kUniform) return spatial_midpoint;
    switch (profile.midpoint) {
        case MidpointChoice::kSpatial:
            return spatial_midpoint;
        case MidpointChoice::kSweep:
            return sweep_midpoint;
        case MidpointChoice::kMlslSbplx:
            return mlsl_sbplx_midpoint;
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

// Calls `use(kernel)` with the kernel that the profile's precision and bias ask for.
template <typename Use>
auto with_kernel(const Scene& scene, const Primitives& primitives, const Profile& profile,
                 Use&& use) {
    switch (profile.precision) {
        case Precision::kFloat:
            return use(PlainKernel<float>(scene, primitives, profile.bias));
        case Precision::kDouble:
            return use(PlainKernel<double>(scene, primitives, profile.bias));
        case Precision::kExact:
            break;
    }
    return use(ExactKernel(scene, primitives, profile.bias));
}

// Calls `use(search)` with the search that the profile's walk and step ask for.
template <typename Kernel, typename Counter, typename Use>
auto with_search(const Kernel& kernel, const Primitives& primitives, const Octree& octree,
                 const Profile& profile, Counter counter, Use&& use) {
    const auto with_locator = [&]<typename Locator>(Locator) {
        if (profile.step)
            return use(NudgedSearch<Kernel, Locator, Counter>(kernel, primitives, octree,
                                                              *profile.step, counter));
        return use(ExactSearch<Kernel, Locator, Counter>(kernel, primitives, octree, counter));
    };
    if (profile.walk == WalkChoice::kHash) return with_locator(HashLocator{});
    return with_locator(DescentLocator{});
}

template <typename Kernel, typename Search>
std::vector<RayAnswer> answers(const Scene& scene, const Kernel& kernel, Search search,
                               std::span<const Ray> rays) {
    std::vector<RayAnswer> out;
    out.reserve(rays.size());
    for (const Ray& ray : rays) {
        const auto hit = search.closest(kernel.prepare(ray));
        RayAnswer answer;
        answer.t = std::numeric_limits<double>::infinity();
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
    void hit(PrimitiveId primitive) { facts.primitive = primitive; }
    void lit(std::size_t light) {
        facts.lit ^= light < 64 ? std::uint64_t{1} << light : mixed(light);
    }
};

}  // namespace

Octree build_tree(const Scene& scene, const Primitives& primitives, const Profile& profile) {
    BuildOptions options;
    options.midpoint = midpoint_strategy(profile);
    if (profile.costs == CostChoice::kThesis) {
        options.worth = CostModel(ThesisCosts{weighted_shapes(scene, profile.thesis_weight),
                                              static_cast<double>(scene.lights.size())});
        options.max_depth = kThesisMaxDepth;
    } else {
        options.midpoint = shrinking(options.midpoint);
        options.fallback = shrinking(spatial_midpoint);
        options.max_references =
            kReferencesPerItem * primitives.item_count() + kReferencesOfSmallScenes;
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
    return build_octree(primitives.item_boxes, options);
}

Image render(const Scene& scene, const Primitives& primitives, const Octree& octree,
             const Profile& profile, Resolution resolution) {
    return with_kernel(scene, primitives, profile, [&](const auto& kernel) {
        return with_search(kernel, primitives, octree, profile, NoCounter{}, [&](auto search) {
            return Tracer(scene, kernel, std::move(search)).image(resolution);
        });
    });
}

Image render_brute_force(const Scene& scene, const Primitives& primitives, const Profile& profile,
                         Resolution resolution) {
    return with_kernel(scene, primitives, profile, [&](const auto& kernel) {
        return Tracer(scene, kernel, BruteForceSearch(kernel, primitives)).image(resolution);
    });
}

std::vector<PixelFacts> render_facts(const Scene& scene, const Primitives& primitives,
                                     const Octree& octree, const Profile& profile,
                                     Resolution resolution) {
    std::vector<PixelFacts> facts;
    const RayGenerator rays(scene.camera, resolution);
    with_kernel(scene, primitives, profile, [&](const auto& kernel) {
        with_search(kernel, primitives, octree, profile, NoCounter{}, [&](auto search) {
            Tracer tracer(scene, kernel, std::move(search));
            for (int y = 0; y < resolution.height; ++y)
                for (int x = 0; x < resolution.width; ++x)
                    tracer.color(rays.ray(x, y), FactsObserver{facts.emplace_back()});
        });
    });
    return facts;
}

TraceCounts count_events(const Scene& scene, const Primitives& primitives, const Octree& octree,
                         const Profile& profile, Resolution resolution) {
    TraceCounts counts;
    std::uint64_t tested = 0;
    with_kernel(scene, primitives, profile, [&](const auto& kernel) {
        const EventCounter counter{&counts, &tested};
        with_search(kernel, primitives, octree, profile, counter, [&](auto search) {
            Tracer tracer(scene, kernel, std::move(search));
            tracer.image(resolution);
            counts.primary_rays = tracer.primary_rays();
            counts.shadow_rays = tracer.shadow_rays();
        });
        if constexpr (std::is_same_v<std::decay_t<decltype(kernel)>, ExactKernel>) {
            const StageCounts& stages = kernel.stage_counts();
            counts.predicates = PredicateCounts{tested, stages.wider, stages.exact};
        }
    });
    return counts;
}

std::vector<RayAnswer> closest_hits(const Scene& scene, const Primitives& primitives,
                                    const Octree* octree, const Profile& profile,
                                    std::span<const Ray> rays) {
    return with_kernel(scene, primitives, profile, [&](const auto& kernel) {
        if (!octree) return answers(scene, kernel, BruteForceSearch(kernel, primitives), rays);
        return with_search(kernel, primitives, *octree, profile, NoCounter{}, [&](auto search) {
            return answers(scene, kernel, std::move(search), rays);
        });
    });
}

}  // namespace nuvo
