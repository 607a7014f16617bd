#include "contest.h"

#include <algorithm>
#include <cstdlib>
#include <random>
#include <stdexcept>

#include "nuvo/image/bmp.h"
#include "nuvo/math/big_vector.h"

// Both sides in one process and in turn, so that whatever else the machine does meets both.

namespace nuvo::bench {
namespace {

/// Rays between random points; enough for a steady rate.
constexpr std::size_t kRays = 200'000;
constexpr std::uint64_t kRaySeed = 1;

FastOptions fast_options(const ContestOptions& options, std::optional<OctreeType> type) {
    FastOptions fast;
    fast.type = type;
    fast.isa = instruction_set(options.isa);
    fast.back_faces = options.back_faces;
    return fast;
}

double wall_seconds(const app::ProcessStopwatch& watch) { return watch.elapsed().wall_seconds; }

// Memory that this process has used before is at hand; some that it has not may first have to be
// fetched by the system below, as slowly as it likes. Both sides begin with enough that was used,
// on pages of either size: a system keeps them apart.
template <typename Bytes>
void use(std::size_t count) {
    const Bytes used(count, 1);
    const volatile char sink = used[count / 2];
    static_cast<void>(sink);
}
void warm_memory(std::size_t primitives) {
    constexpr std::size_t kBytesEach = 640;
    const std::size_t count = primitives * kBytesEach + (std::size_t{1} << 26);
    use<std::vector<char>>(count);
    use<BigVector<char>>(count);
}

void our_round(const Scene& scene, const ContestOptions& options, OurSamples& samples,
               Image& picture) {
    const app::StageStopwatch scratch;
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    FastTracer tracer(scene, primitives, fast_options(options, samples.type));
    samples.build.push_back(scratch.seconds());
    tracer.render(options.resolution);
    samples.scratch.push_back(scratch.seconds());
    samples.frame.push_back(timed(picture, [&] { return tracer.render(options.resolution); }));
    FastTimes times;
    tracer.render(options.resolution, &times);
    samples.tables.push_back(times.tables);
    samples.primary.push_back(times.primary);
    samples.shadow.push_back(times.shadow);
    samples.shading.push_back(times.shading);
    samples.memory = tracer.memory();
}

void embree_round(const FloatScene& floats, const ContestOptions& options, const Survey& survey,
                  EmbreeSamples& samples, Image& picture) {
    const app::StageStopwatch scratch;
    const BlockKeeper pictures;  // as the tracer holds one
    const EmbreeScene built(floats, survey.options);
    samples.build.push_back(scratch.seconds());
    const EmbreeFrame frame(built, options.resolution);
    frame.render(survey.mode, Depth::kWhole);
    samples.scratch.push_back(scratch.seconds());
    const auto depth_seconds = [&](Depth depth) {
        return timed(picture, [&] { return frame.render(survey.mode, depth); });
    };
    samples.primary.push_back(depth_seconds(Depth::kPrimary));
    samples.trace.push_back(depth_seconds(Depth::kTrace));
    samples.frame.push_back(depth_seconds(Depth::kWhole));
    samples.memory = built.memory();
}

Agreement agreement(const Image& ours, const Image& theirs) {
    Agreement result;
    for (std::size_t i = 0; i < ours.pixels().size(); ++i) {
        const Rgb8& a = ours.pixels()[i];
        const Rgb8& b = theirs.pixels()[i];
        const int off = std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
        result.differing += off > 0;
        result.visible += off > Agreement::kVisible;
    }
    return result;
}

/// Rays from one random point of the box to another.
std::vector<Ray> random_rays(const Primitives& primitives) {
    Bounds3 box;
    for (const Bounds3& item : primitives.item_boxes) box = box.extended(item);
    std::mt19937_64 engine(kRaySeed);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto point = [&] {
        Point3 p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = box.min[axis] + unit(engine) * box.widths()[axis];
        return p;
    };
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < kRays; ++i) {
        const Point3 from = point();
        rays.push_back({from, normalized(point() - from)});
    }
    return rays;
}

/// Whether Embree's hit is ours. Its distance tells, as both sides number primitives differently.
bool same_hit(const RayAnswer& ours, const SingleHit& theirs, double scale) {
    constexpr double kSameDistance = 0x1p-16;  // of the scene's size: single precision's rounding
    if (ours.hit != theirs.hit) return false;
    return !ours.hit || std::abs(ours.t - theirs.t) <= kSameDistance * scale;
}

}  // namespace

InstructionSet instruction_set(const std::string& name) {
    if (name.empty()) return InstructionSet::kBest;
    if (name == "avx512") return InstructionSet::kAvx512;
    if (name == "avx2") return InstructionSet::kAvx2;
    if (name == "sse4.2") return InstructionSet::kSse4;
    if (name == "sse2") return InstructionSet::kSse2;
    throw std::invalid_argument("--isa=" + name + ": none of avx512, avx2, sse4.2 and sse2");
}

FrameContest contest_frames(const Scene& scene, const ContestOptions& options,
                            const Survey& survey) {
    FrameContest contest;
    for (const auto& type : options.types) contest.ours.emplace_back().type = type;
    Image ours;
    Image theirs;
    const std::size_t count = flatten(scene, LeafContent::kPrimitives).sources.size();
    for (int round = 0; round < options.rounds; ++round) {
        for (OurSamples& samples : contest.ours) {
            warm_memory(count);
            our_round(scene, options, samples, ours);
        }
        const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
        FloatScene floats;
        contest.embree.convert.push_back(
            timed(floats, [&] { return to_float(scene, primitives); }));
        warm_memory(count);
        embree_round(floats, options, survey, contest.embree, theirs);
    }
    contest.agreement = agreement(ours, theirs);
    if (options.pictures) {
        image::write_bmp(*options.pictures + "-ours.bmp", ours);
        image::write_bmp(*options.pictures + "-embree.bmp", theirs);
    }
    return contest;
}

std::size_t pixels_unlike_exact(const Scene& scene, const ContestOptions& options) {
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    Profile profile = exact_profile();
    profile.walk = WalkChoice::kDescent;
    profile.back_faces = options.back_faces;
    const Octree octree = build_tree(scene, primitives, profile);
    const Image exact = render(scene, primitives, octree, profile, options.resolution);
    std::size_t differing = 0;
    for (const auto& type : options.types) {
        FastTracer tracer(scene, primitives, fast_options(options, type));
        differing += agreement(exact, tracer.render(options.resolution)).differing;
    }
    return differing;
}

RayContest contest_rays(const Scene& scene, const ContestOptions& options, const Survey& survey) {
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const FloatScene floats = to_float(scene, primitives);
    const EmbreeScene built(floats, survey.options);
    // Frames have chosen the kind of sphere; single rays may be faster with the other.
    std::optional<EmbreeScene> other;
    if (!floats.spheres.empty()) {
        EmbreeOptions options_of_other = survey.options;
        const bool point = survey.options.spheres == SphereKind::kPoint;
        options_of_other.spheres = point ? SphereKind::kUser : SphereKind::kPoint;
        other.emplace(floats, options_of_other);
    }
    const std::vector<Ray> rays = random_rays(primitives);
    std::vector<FastTracer> tracers;
    for (const auto& type : options.types) {
        FastOptions fast = fast_options(options, type);
        fast.back_faces = BackFaces::kDraw;  // as Embree sees them
        tracers.emplace_back(scene, primitives, fast);
        tracers.back().closest_hits(std::span(rays).first(1));  // builds
    }
    RayContest contest;
    contest.rays = rays.size();
    contest.ours.resize(tracers.size());
    std::vector<RayAnswer> ours;
    std::vector<SingleHit> theirs;
    for (int round = 0; round < options.rounds; ++round) {
        for (std::size_t i = 0; i < tracers.size(); ++i)
            contest.ours[i].push_back(timed(ours, [&] { return tracers[i].closest_hits(rays); }));
        double seconds = timed(theirs, [&] { return closest_hits(built, rays); });
        if (other)
            seconds = std::min(seconds, timed(theirs, [&] { return closest_hits(*other, rays); }));
        contest.embree.push_back(seconds);
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
        contest.hits += ours[i].hit;
        contest.differing += !same_hit(ours[i], theirs[i], floats.largest_coordinate);
    }
    return contest;
}

ExactnessPrice price_of_exactness(const Scene& scene, const ContestOptions& options,
                                  std::optional<OctreeType> type) {
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    FastOptions fast = fast_options(options, type);
    FastTracer exact(scene, primitives, fast);
    fast.redo_exactly = false;
    FastTracer plain(scene, primitives, fast);
    ExactnessPrice price;
    Image with;
    Image without;
    for (int round = 0; round < options.rounds; ++round) {
        price.exact.push_back(timed(with, [&] { return exact.render(options.resolution); }));
        price.plain.push_back(timed(without, [&] { return plain.render(options.resolution); }));
    }
    price.differing = agreement(with, without).differing;
    return price;
}

ThreadContest contest_threads(const Scene& scene, const ContestOptions& options,
                              const Survey& survey, std::optional<OctreeType> type) {
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const FloatScene floats = to_float(scene, primitives);
    const EmbreeScene built(floats, survey.options);
    const EmbreeFrame frame(built, options.resolution);
    ThreadContest contest;
    std::optional<Image> first;
    const auto our_turn = [&](int threads, Samples& build, Samples& render) {
        FastOptions fast = fast_options(options, type);
        fast.threads = threads;
        const app::ProcessStopwatch build_watch;
        FastTracer tracer(scene, primitives, fast);
        build.push_back(wall_seconds(build_watch));
        tracer.render(options.resolution);
        const app::ProcessStopwatch watch;
        Image picture = tracer.render(options.resolution);
        render.push_back(wall_seconds(watch));
        if (!first) first = picture;
        contest.same_bytes = contest.same_bytes && picture == *first;
    };
    const auto their_turn = [&](int threads, Samples& render) {
        const app::ProcessStopwatch watch;
        frame.render(survey.mode, Depth::kWhole, threads);
        render.push_back(wall_seconds(watch));
    };
    for (int round = 0; round < options.rounds; ++round) {
        our_turn(1, contest.ours_build_one, contest.ours_one);
        our_turn(2, contest.ours_build_two, contest.ours_two);
        their_turn(1, contest.embree_one);
        their_turn(2, contest.embree_two);
    }
    return contest;
}

}  // namespace nuvo::bench
