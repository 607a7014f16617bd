#include "run.h"

#include <algorithm>
#include <iomanip>
#include <limits>
#include <mutex>
#include <ostream>
#include <sstream>

#include "classes.h"
#include "nuvo/math/parallel.h"
#include "nuvo/render/fast.h"
#include "oracle.h"
#include "threads.h"

namespace nuvo::hard {
namespace {

struct Batch {
    std::size_t class_index;
    std::uint64_t number;
    int rays;
};

// Every combination of tree, leaf and walk comes up.
Profile any_profile(Random& random, bool deep_trees) {
    Profile profile = exact_profile();
    profile.type = random.below(3) == 0 ? OctreeType::kUniform : OctreeType::kNonuniform;
    profile.midpoint = random.chance() ? MidpointChoice::kPublished : MidpointChoice::kSweep;
    profile.walk = random.chance() ? WalkChoice::kHash : WalkChoice::kDescent;
    if (random.below(4) == 0) profile.leaves = LeafContent::kShapes;
    if (random.below(4) == 0) profile.max_objects = deep_trees ? 2 : 16;
    return profile;
}

std::string text(const Ray& ray) {
    std::ostringstream out;
    out << std::hexfloat << "{{" << ray.origin.x << ", " << ray.origin.y << ", " << ray.origin.z
        << "}, {" << ray.direction.x << ", " << ray.direction.y << ", " << ray.direction.z << "}}";
    return out.str();
}

std::string text(const RayAnswer& answer) {
    if (!answer.hit) return "nothing";
    std::ostringstream out;
    out << "shape " << answer.shape << " triangle " << answer.triangle << " at "
        << std::setprecision(17) << answer.t;
    return out.str();
}

double relative(const Real& difference, const Real& whole) {
    return static_cast<double>(Real(abs(difference) / whole));
}

// Why the answer is wrong; empty: it is right.
std::string judge_one(const Oracle& oracle, const Ray& ray, const RayAnswer& answer, Tally& tally) {
    const OracleRay prepared = oracle.prepare(ray);
    const std::optional<OracleAnswer> truth = oracle.closest(prepared);
    ++tally.rays;
    if (!truth) {
        tally.false_hits += answer.hit;
        return answer.hit ? "false hit" : "";
    }
    ++tally.hits;
    if (!answer.hit) {
        ++tally.missed;
        return "missed";
    }
    const auto object = static_cast<std::size_t>(answer.shape);
    const auto triangle = static_cast<std::size_t>(answer.triangle);
    const Real t = prepared.t(truth->root);
    if (object != truth->object || triangle != truth->triangle) {
        const auto other = oracle.root(prepared, object, triangle);
        if (other && compare(*other, truth->root) == 0) {
            ++tally.tie_breaks;
            return "tie broken";
        }
        ++tally.wrong_primitive;
        constexpr double kAgree = 1e-14;
        if (!other || relative(prepared.t(*other) - t, t) > kAgree) ++tally.wrong_apart;
        return "wrong primitive";
    }
    // Below the normal range a double has no relative accuracy to ask for.
    const Real normal = std::max(t, Real(std::numeric_limits<double>::min()));
    const double error = relative(Real(answer.t) - t, normal);
    double& worst = truth->root.near_tangency ? tally.worst_t_tangent : tally.worst_t;
    worst = std::max(worst, error);
    return "";
}

std::vector<RayAnswer> fast_answers(const Scene& scene, std::span<const Ray> rays,
                                    std::uint64_t number) {
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const auto sets = supported_instruction_sets();
    FastOptions options;
    options.isa = sets[number % sets.size()];
    return FastTracer(scene, primitives, options).closest_hits(rays);
}

Tally run_batch(const HardClass& hard_class, const Batch& batch, const RunOptions& options,
                std::ostream& faults) {
    const auto kind = static_cast<Coordinates>(batch.number % 3);
    Random random(mixed_seed(options.seed, batch.class_index, batch.number), kind);
    Scene scene = hard_class.scene(random);
    if (options.solid)
        for (std::size_t i = 0; i < scene.objects.size(); ++i)
            scene.objects[i].solid = (i + batch.number) % 2 == 0;
    Profile profile = any_profile(random, hard_class.deep_trees);
    profile.precision = options.precision;
    const Primitives primitives = flatten(scene, profile.leaves);
    const Octree octree = build_tree(scene, primitives, profile);
    Aims aims(scene, octree, random);
    std::vector<Ray> rays;
    for (int i = 0; i < batch.rays; ++i) rays.push_back(hard_class.ray(scene, aims, random));
    const auto answers = options.fast ? fast_answers(scene, rays, batch.number)
                                      : closest_hits(scene, primitives, &octree, profile, rays);
    const std::string label = std::string(hard_class.name) + " batch " +
                              std::to_string(batch.number) + " seed " +
                              std::to_string(options.seed);
    return judge(scene, rays, answers, label, faults);
}

std::vector<Batch> batches_of(const RunOptions& options, std::size_t& chosen) {
    const auto classes = hard_classes();
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < classes.size(); ++i)
        if (options.only.empty() || options.only == classes[i].name) indices.push_back(i);
    chosen = indices.size();
    std::vector<Batch> batches;
    for (std::size_t k = 0; k < indices.size(); ++k) {
        // Shares that add up to all rays.
        const std::uint64_t n = indices.size();
        std::uint64_t left = options.rays * (k + 1) / n - options.rays * k / n;
        for (std::uint64_t number = 0; left > 0; ++number) {
            const auto size = std::min<std::uint64_t>(left, options.rays_per_scene);
            batches.push_back({indices[k], number, static_cast<int>(size)});
            left -= size;
        }
    }
    return batches;
}

}  // namespace

Tally& Tally::operator+=(const Tally& other) {
    rays += other.rays;
    hits += other.hits;
    missed += other.missed;
    false_hits += other.false_hits;
    wrong_primitive += other.wrong_primitive;
    wrong_apart += other.wrong_apart;
    tie_breaks += other.tie_breaks;
    worst_t = std::max(worst_t, other.worst_t);
    worst_t_tangent = std::max(worst_t_tangent, other.worst_t_tangent);
    return *this;
}

bool Tally::right(bool float_exact) const {
    const std::uint64_t wrong = float_exact ? wrong_primitive : wrong_apart;
    return missed + false_hits + tie_breaks + wrong == 0 && worst_t <= 1e-13 &&
           worst_t_tangent <= 1e-11;
}

Tally judge(const Scene& scene, std::span<const Ray> rays, std::span<const RayAnswer> answers,
            const std::string& label, std::ostream& faults) {
    const Oracle oracle(scene);
    Tally tally;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::string fault = judge_one(oracle, rays[i], answers[i], tally);
        if (fault.empty()) continue;
        const auto truth = oracle.closest(oracle.prepare(rays[i]));
        RayAnswer expected;
        if (truth)
            expected = {true, static_cast<std::int64_t>(truth->object),
                        static_cast<std::int64_t>(truth->triangle),
                        static_cast<double>(oracle.prepare(rays[i]).t(truth->root))};
        faults << label << " ray " << i << " " << text(rays[i]) << ": " << fault << ", "
               << text(answers[i]) << " instead of " << text(expected) << "\n";
    }
    return tally;
}

std::vector<ClassTally> run(const RunOptions& options, std::ostream& faults) {
    std::size_t chosen = 0;
    const std::vector<Batch> batches = batches_of(options, chosen);
    const auto classes = hard_classes();
    std::vector<ClassTally> tallies(classes.size());
    for (std::size_t i = 0; i < classes.size(); ++i) tallies[i].name = classes[i].name;
    std::mutex mutex;
    for_each_index(thread_count(options.threads), batches.size(), [&](std::size_t i, int) {
        const Batch& batch = batches[i];
        std::ostringstream found;
        const Tally tally = run_batch(classes[batch.class_index], batch, options, found);
        const std::lock_guard lock(mutex);
        const bool full = static_cast<Coordinates>(batch.number % 3) == Coordinates::kDouble;
        ClassTally& sum = tallies[batch.class_index];
        (full ? sum.full_double : sum.float_exact) += tally;
        faults << found.str();
    });
    std::erase_if(tallies, [](const ClassTally& tally) {
        return tally.float_exact.rays + tally.full_double.rays == 0;
    });
    return tallies;
}

namespace {

void print_row(std::ostream& out, const std::string& name, const Tally& tally) {
    out << "| " << std::left << std::setw(26) << name << std::right << " | " << std::setw(9)
        << tally.rays << " | " << std::setw(9) << tally.hits << " | " << std::setw(6)
        << tally.missed << " | " << std::setw(5) << tally.false_hits << " | " << std::setw(5)
        << tally.wrong_primitive << " | " << std::setw(4) << tally.tie_breaks << " | "
        << std::scientific << std::setprecision(1) << std::setw(8) << tally.worst_t << " | "
        << std::setw(8) << tally.worst_t_tangent << " |\n";
}

}  // namespace

bool print(std::ostream& out, const std::vector<ClassTally>& tallies) {
    out << "| class                      |      rays |      hits | missed | false | wrong | ties |"
           "  worst t | grazing t |\n"
           "|---|---|---|---|---|---|---|---|---|\n";
    Tally float_exact;
    Tally full_double;
    bool right = true;
    for (const ClassTally& tally : tallies) {
        Tally both = tally.float_exact;
        print_row(out, tally.name, both += tally.full_double);
        right = right && tally.float_exact.right(true) && tally.full_double.right(false);
        float_exact += tally.float_exact;
        full_double += tally.full_double;
    }
    print_row(out, "float-exact input", float_exact);
    print_row(out, "full-double input", full_double);
    Tally all = float_exact;
    print_row(out, "in all", all += full_double);
    return right;
}

}  // namespace nuvo::hard
