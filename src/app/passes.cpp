#include "passes.h"

#include <algorithm>
#include <thread>

#include "nuvo/app/choices.h"
#include "nuvo/image/samples.h"
#include "nuvo/render/sah_prices.h"
#include "remarks.h"

namespace nuvo::app {
namespace {

void note(std::vector<double>& seconds, std::vector<double>& wall_seconds,
          const StageStopwatch& watch) {
    seconds.push_back(watch.seconds());
    wall_seconds.push_back(watch.wall_seconds());
}

/// One way to build and to render: an octree to be walked serially.
class SerialRun {
  public:
    SerialRun(const Scene& scene, const Options&, const Profile& profile, Meter& meter)
        : scene_(scene),
          profile_(profile),
          meter_(meter),
          progress_(meter.begin("building")),
          primitives_(flatten(scene, profile.leaves)),
          octree_(build_tree(scene, primitives_, profile, progress_)) {}

    Image picture(Resolution resolution) {
        return render(scene_, primitives_, octree_, profile_, resolution, progress_);
    }
    std::vector<RayAnswer> answers(std::span<const Ray> rays) const {
        return closest_hits(scene_, primitives_, &octree_, profile_, rays, progress_);
    }
    void describe(Pass& pass, const Options& options) const {
        pass.memory.primitives = memory_bytes(primitives_);
        if (options.json) pass.memory.tracer = tracer_bytes(scene_, primitives_, profile_);
        pass.tree = figures(octree_);
        pass.tree->sah =
            final_sah(octree_, sah_prices(scene_, primitives_, profile_, octree_.leaf_count()));
    }
    void count(Pass& pass, const Options& options) const {
        meter_.begin("counting");
        if (options.wants_planes()) {
            pass.planes = record_planes(scene_, primitives_, &octree_, profile_, options.resolution,
                                        progress_);
            pass.counts = pass.planes->counts;
        } else if (options.counters || options.json) {
            pass.counts = count_events(scene_, primitives_, octree_, profile_,
                                       options.traced_resolution(), progress_);
        }
    }
    /// Gives the octree away.
    void leave_octree(Pass& pass) { pass.octree = std::move(octree_); }

  private:
    const Scene& scene_;
    const Profile& profile_;
    Meter& meter_;
    Progress* progress_;
    Primitives primitives_;
    Octree octree_;
};

// The tile tracer's profiles hold the answers of the exact one, whose pictures it makes.
Profile as_serial(Profile profile) {
    profile.tracer = TracerChoice::kSerial;
    return profile;
}

/// The other: the tile tracer.
class TileRun {
  public:
    TileRun(const Scene& scene, const Options& options, const Profile& profile, Meter& meter)
        : scene_(scene),
          walked_(as_serial(profile)),
          meter_(meter),
          options_(fast_options(options, profile, meter.begin("building"))),
          primitives_(flatten(scene, LeafContent::kPrimitives, options_.threads)),
          tracer_(scene, primitives_, options_) {}

    Image picture(Resolution resolution) { return tracer_.render(resolution); }
    std::vector<RayAnswer> answers(std::span<const Ray> rays) {
        return tracer_.closest_hits_once(rays);
    }
    void describe(Pass& pass, const Options&) const {
        pass.name = name_of(kOctreeTypes, tracer_.octree_type());
        pass.memory.primitives = memory_bytes(primitives_);
        pass.tiles = figures(tracer_, options_);
    }
    void count(Pass& pass, const Options& options) {
        meter_.begin("counting");
        if (options.counters || options.json) {
            pass.tiles->counts = tracer_.count_rays(options.traced_resolution());
            tracer_.render(options.traced_resolution(), &pass.tiles->stage_seconds.emplace());
        }
        if (!options.wants_planes() && !options.octree) return;
        walked_.type = tracer_.octree_type();
        walk_.emplace(scene_, options, walked_, meter_);
        walk_->describe(pass, options);
        if (options.wants_planes()) walk_->count(pass, options);
    }
    OctreeType octree_type() const { return tracer_.octree_type(); }
    void leave_octree(Pass& pass) { walk_->leave_octree(pass); }

  private:
    const Scene& scene_;
    Profile walked_;
    Meter& meter_;
    FastOptions options_;
    Primitives primitives_;
    FastTracer tracer_;
    std::optional<SerialRun> walk_;  // that others can look at
};

template <typename Run>
Pass run_repeatedly(const Scene& scene, const Options& options, const Profile& profile,
                    int repetitions, Meter& meter, Image& picture) {
    Pass pass;
    pass.name = name_of(kOctreeTypes, profile.type);
    std::optional<Run> run;
    Image samples;
    const ProcessStopwatch process;
    for (int i = 0; i < repetitions; ++i) {
        run.reset();
        meter.begin_part("repetition", static_cast<std::size_t>(i) + 1,
                         static_cast<std::size_t>(repetitions));
        const StageStopwatch build;
        run.emplace(scene, options, profile, meter);
        note(pass.build_seconds, pass.build_wall_seconds, build);
        if (i == 0) pass.memory.peak_building = peak_memory_bytes();
        picture = samples = Image();  // two pictures need not be held at once
        meter.begin("tracing");
        const StageStopwatch trace;
        samples = run->picture(options.traced_resolution());
        if (options.samples > 1) picture = image::averaged(samples, options.samples);
        note(pass.trace_seconds, pass.trace_wall_seconds, trace);
        if (i == 0) pass.memory.peak_tracing = peak_memory_bytes();
    }
    pass.process = process.elapsed();
    meter.end();
    run->describe(pass, options);
    run->count(pass, options);
    meter.end();
    pass.remarks = remarks(scene, options, profile, samples,
                           [&](std::span<const Ray> rays) { return run->answers(rays); });
    pass.memory.picture = vector_bytes(picture.pixels()) + vector_bytes(samples.pixels());
    if (options.samples == 1) picture = std::move(samples);
    if (options.octree) run->leave_octree(pass);
    return pass;
}

template <typename Run>
Pass answer_once(const Scene& scene, const Options& options, std::span<const Ray> rays,
                 Meter& meter, std::vector<RayAnswer>& answers) {
    Pass pass;
    pass.name = name_of(kOctreeTypes, options.profile.type);
    const ProcessStopwatch process;
    const StageStopwatch build;
    Run run(scene, options, options.profile, meter);
    note(pass.build_seconds, pass.build_wall_seconds, build);
    pass.memory.peak_building = peak_memory_bytes();
    meter.begin("answering");
    const StageStopwatch trace;
    answers = run.answers(rays);
    note(pass.trace_seconds, pass.trace_wall_seconds, trace);
    pass.memory.peak_tracing = peak_memory_bytes();
    meter.end();
    pass.process = process.elapsed();
    run.describe(pass, options);
    return pass;
}

}  // namespace

Profile walked_profile(const Scene& scene, const Options& options, Meter& meter) {
    if (options.profile.tracer == TracerChoice::kSerial) return options.profile;
    Profile walked = as_serial(options.profile);
    walked.type = TileRun(scene, options, options.profile, meter).octree_type();
    meter.end();
    return walked;
}

FastOptions fast_options(const Options& options, const Profile& profile, Progress* progress) {
    FastOptions fast;
    fast.progress = progress;
    if (!type_is_measured(options)) fast.type = profile.type;
    fast.back_faces = profile.back_faces;
    fast.isa =
        options.isa == InstructionSet::kBest ? supported_instruction_sets().front() : options.isa;
    fast.threads = options.thread_count();
    return fast;
}

Pass run_pass(const Scene& scene, const Options& options, const Profile& profile, int repetitions,
              Meter& meter, Image& picture) {
    if (profile.tracer == TracerChoice::kTiles)
        return run_repeatedly<TileRun>(scene, options, profile, repetitions, meter, picture);
    return run_repeatedly<SerialRun>(scene, options, profile, repetitions, meter, picture);
}

Pass run_brute_force(const Scene& scene, const Options& options, Meter& meter, Image& picture) {
    Pass pass;
    pass.name = "brute force";
    const Primitives primitives = flatten(scene, options.profile.leaves);
    Progress* const progress = meter.begin("tracing by brute force");
    const ProcessStopwatch process;
    const StageStopwatch trace;
    picture = render_brute_force(scene, primitives, options.profile, options.traced_resolution(),
                                 progress);
    if (options.samples > 1) picture = image::averaged(picture, options.samples);
    note(pass.trace_seconds, pass.trace_wall_seconds, trace);
    pass.process = process.elapsed();
    pass.memory = {memory_bytes(primitives),
                   options.json ? tracer_bytes(scene, primitives, options.profile) : 0,
                   vector_bytes(picture.pixels()), 0, peak_memory_bytes()};
    if (options.wants_planes()) {
        meter.begin("counting by brute force");
        pass.planes = record_planes(scene, primitives, nullptr, options.profile, options.resolution,
                                    progress);
        pass.counts = pass.planes->counts;
    }
    meter.end();
    return pass;
}

Pass run_rays(const Scene& scene, const Options& options, std::span<const Ray> rays, Meter& meter,
              std::vector<RayAnswer>& answers) {
    if (options.profile.tracer == TracerChoice::kTiles)
        return answer_once<TileRun>(scene, options, rays, meter, answers);
    return answer_once<SerialRun>(scene, options, rays, meter, answers);
}

}  // namespace nuvo::app
