#include "measure.h"

#include <algorithm>
#include <memory>
#include <random>

#include "exact_kernel.h"
#include "nuvo/app/clocks.h"
#include "structures/box_tree.h"
#include "structures/grid.h"
#include "tracer.h"

namespace nuvo::study {
namespace {

/// Prices of the box trees' steps, and the grid's cells an item: the best of those tried on the
/// author's scenes (docs/midpoint-study.md).
constexpr double kKdStep = 2;
constexpr double kBvhStep = 2;
constexpr double kGridDensity = 4;
constexpr std::uint64_t kRaySeed = 1;

/// The scene, flattened, and what rays are asked.
struct Setting {
    const Scene& scene;
    Primitives primitives;
    ExactKernel kernel;
    std::vector<Ray> random_rays;

    Setting(const Scene& of, const MeasureOptions& options)
        : scene(of), primitives(flatten(of, options.tree.leaves)), kernel(of, primitives, {}) {
        Bounds3 all;
        for (const Bounds3& box : primitives.item_boxes) all = all.extended(box);
        std::mt19937_64 random(kRaySeed);
        const auto point = [&] {
            Point3 p;
            for (int k = 0; k < 3; ++k)
                p[k] = all.min[k] + all.widths()[k] * static_cast<double>(random() >> 11) * 0x1p-53;
            return p;
        };
        for (std::size_t i = 0; i < options.random_rays && !all.empty(); ++i) {
            const Point3 from = point(), to = point();
            if (!(from == to)) random_rays.push_back({from, to - from});
        }
    }

    template <typename Structure>
    Image picture(const Structure& structure, Resolution resolution, Work& work) const {
        return Tracer(scene, kernel, StructureSearch(kernel, primitives, structure, &work))
            .image(resolution);
    }
    template <typename Structure>
    Work random_work(const Structure& structure) const {
        Work work;
        StructureSearch search(kernel, primitives, structure, &work);
        for (const Ray& ray : random_rays) search.closest(kernel.prepare(ray));
        return work;
    }
};

/// One structure to be measured: how it is built, and what is asked of it.
struct Contestant {
    Row row;
    std::function<void()> build;
    std::function<Image(Resolution, Work&)> picture;
    std::function<Work()> random_work;
    std::function<void(Row&)> describe;
};

template <typename Structure, typename Build>
Contestant contestant(const Setting& setting, std::string name, std::string kind, Build build,
                      std::function<double(const Structure&)> sah) {
    const auto held = std::make_shared<std::unique_ptr<Structure>>();
    Contestant c;
    c.row.name = std::move(name);
    c.row.kind = std::move(kind);
    c.build = [held, build] { *held = std::make_unique<Structure>(build()); };
    c.picture = [held, &setting](Resolution resolution, Work& work) {
        return setting.picture(**held, resolution, work);
    };
    c.random_work = [held, &setting] { return setting.random_work(**held); };
    c.describe = [held, sah](Row& row) {
        row.sizes = (*held)->sizes();
        if (sah) row.sah = sah(**held);
    };
    return c;
}

/// Owns its tree, unlike OctreeStructure.
struct OwnedOctree {
    std::unique_ptr<Octree> octree;
    OctreeStructure structure;

    explicit OwnedOctree(Octree of)
        : octree(std::make_unique<Octree>(std::move(of))), structure(*octree) {}
    template <typename Limit, typename Leaf>
    void visit(const Ray& ray, const Limit& limit, Work& work, const Leaf& leaf) const {
        structure.visit(ray, limit, work, leaf);
    }
    Sizes sizes() const { return structure.sizes(); }
};

std::vector<Contestant> contestants(const Setting& setting, std::span<const Method* const> methods,
                                    bool others, const MeasureOptions& options,
                                    std::vector<Evaluations>& evaluations) {
    const Scene& scene = setting.scene;
    const Primitives& primitives = setting.primitives;
    const CalibratedCosts costs = costs_of(primitives, options.tree.step);
    std::vector<Contestant> all;
    evaluations.assign(methods.size(), {options.evaluations});
    for (std::size_t i = 0; i < methods.size(); ++i)
        all.push_back(contestant<OwnedOctree>(
            setting, std::string(methods[i]->name), "octree",
            [&scene, &primitives, &evaluations, &options, method = methods[i], i] {
                evaluations[i].done = 0;
                return OwnedOctree(
                    build_tree(scene, primitives, *method, options.tree, &evaluations[i]));
            },
            [costs](const OwnedOctree& tree) {
                return sah(sah_totals(*tree.octree),
                           tree.octree->root().voxel.bounds.surface_area(), costs.costs());
            }));
    if (!others) return all;
    const auto overlaps =
        std::make_shared<OverlapTest>(overlap_test(scene, primitives, options.tree.leaves));
    const Bounds3 camera{scene.camera.position, scene.camera.position};
    const double margin = margin_of(primitives, camera);
    const double scale = costs.step / options.tree.step;
    all.push_back(contestant<Grid>(setting, "grid", "other",
                                   [&primitives, overlaps, margin] {
                                       return Grid(primitives.item_boxes, *overlaps, margin,
                                                   kGridDensity);
                                   },
                                   {}));
    all.push_back(contestant<KdTree>(
        setting, "kd-tree", "other",
        [&primitives, overlaps, margin, scale] {
            return KdTree(primitives.item_boxes, *overlaps, margin, kKdStep * scale);
        },
        [scale](const KdTree& tree) {
            return tree.sah({kKdStep * scale, kKdStep * scale, 1});
        }));
    all.push_back(contestant<Bvh>(
        setting, "bvh", "other",
        [&primitives, scale] { return Bvh(primitives.item_boxes, kBvhStep * scale); },
        [scale](const Bvh& tree) {
            return tree.sah({kBvhStep * scale, kBvhStep * scale, 1});
        }));
    return all;
}

}  // namespace

std::vector<Row> measure(const Scene& scene, std::span<const Method* const> methods, bool others,
                         const MeasureOptions& options) {
    const Setting setting(scene, options);
    std::vector<Evaluations> evaluations;
    std::vector<Contestant> all = contestants(setting, methods, others, options, evaluations);
    Work brute_work;
    const Image truth = setting.picture(BruteForce(setting.primitives.item_count()),
                                        options.brute_resolution, brute_work);
    Image first;
    for (Contestant& c : all) {
        c.build();
        c.describe(c.row);
        const Image picture = c.picture(options.resolution, c.row.camera);
        if (first.width() == 0) first = picture;
        c.row.same_picture = picture == first;
        Work ignored;
        c.row.same_as_brute = c.picture(options.brute_resolution, ignored) == truth;
        c.row.random = c.random_work();
    }
    for (std::size_t i = 0; i < methods.size(); ++i)
        all[i].row.evaluations = static_cast<double>(evaluations[i].done);
    // Interleaved, every other round backwards: a machine that slows down does so for all.
    for (int round = 0; round < options.rounds; ++round)
        for (std::size_t k = 0; k < all.size(); ++k) {
            Contestant& c = all[round % 2 == 0 ? k : all.size() - 1 - k];
            const app::StageStopwatch build;
            c.build();
            c.row.build_seconds.push_back(build.seconds());
            Work ignored{.timed = true};
            const app::StageStopwatch trace;
            c.picture(options.resolution, ignored);
            c.row.trace_seconds.push_back(trace.seconds());
        }
    std::vector<Row> rows;
    for (Contestant& c : all) rows.push_back(std::move(c.row));
    return rows;
}

}  // namespace nuvo::study
