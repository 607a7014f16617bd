#include "pipelines.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <deque>
#include <optional>
#include <sstream>

#include "nuvo/app/rays.h"
#include "nuvo/render/fast.h"
#include "nuvo/render/render.h"

namespace nuvo::fuzz {
namespace {

constexpr Resolution kTimed{160, 90};
// More than that many tests are no work for brute force: another pipeline is the reference then.
constexpr double kMostTests = 3e6;
// Brute force may take that much longer than the others.
constexpr double kPatience = 20;

double processor_seconds() {
    timespec time{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

struct SerialWay {
    const char* name;
    OctreeType type;
    MidpointChoice midpoint;
};
constexpr SerialWay kSerialWays[] = {
    {"exact uniform", OctreeType::kUniform, MidpointChoice::kSpatial},
    {"exact nonuniform", OctreeType::kNonuniform, MidpointChoice::kPublished},
    {"exact sweep", OctreeType::kNonuniform, MidpointChoice::kSweep},
};

const char* name_of(InstructionSet isa) {
    switch (isa) {
        case InstructionSet::kAvx512:
            return "avx512";
        case InstructionSet::kAvx2:
            return "avx2";
        case InstructionSet::kSse4:
            return "sse4";
        case InstructionSet::kSse2:
            return "sse2";
        case InstructionSet::kBest:
            break;
    }
    return "best";
}

std::string fast_name(const FastOptions& options) {
    std::string name = "fast ";
    name += options.type == OctreeType::kUniform ? "uniform " : "nonuniform ";
    name += name_of(options.isa);
    return options.threads == 1 ? name : name + " threads";
}

std::string text(const Rgb8& c) {
    return std::to_string(c.r) + "," + std::to_string(c.g) + "," + std::to_string(c.b);
}

std::optional<std::string> difference(const Image& expected, const Image& found) {
    if (expected == found) return std::nullopt;
    int count = 0, worst = 0;
    std::ostringstream first;
    for (int y = 0; y < expected.height(); ++y)
        for (int x = 0; x < expected.width(); ++x) {
            const Rgb8 a = expected.at(x, y);
            const Rgb8 b = found.at(x, y);
            if (a == b) continue;
            worst =
                std::max({worst, std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
            if (++count == 1)
                first << "the first at " << x << "," << y << ": " << text(b) << " instead of "
                      << text(a);
        }
    return std::to_string(count) + " of " + std::to_string(expected.pixels().size()) +
           " pixels differ by up to " + std::to_string(worst) + ", " + first.str();
}

std::string text(const RayAnswer& a) {
    std::ostringstream out;
    out.precision(17);
    out << a.hit << " " << a.shape << " " << a.triangle << " " << a.t;
    return out.str();
}

bool same(const RayAnswer& a, const RayAnswer& b) {
    return a.hit == b.hit && a.shape == b.shape && a.triangle == b.triangle && a.t == b.t;
}

// One scene through all pipelines.
class Checker {
  public:
    Checker(const Scene& scene, const Document& document, const Listener& listener)
        : scene_(scene),
          resolution_(document.resolution),
          fast_(document.fast),
          listener_(listener),
          primitives_(flatten(scene, LeafContent::kPrimitives)) {
        std::string lines;
        for (const std::string& ray : document.rays) lines += ray + "\n";
        rays_ = app::parse_rays(lines, "rays");
    }

    // All pictures before all rays, as what crashes or never ends hides what would come after.
    void run() {
        brute_force();
        for (const SerialWay& way : kSerialWays) serial(way);
        if (fast_)
            for (const InstructionSet isa : supported_instruction_sets())
                for (const OctreeType type : {OctreeType::kUniform, OctreeType::kNonuniform})
                    for (const int threads : {1, 3}) fast({type, threads, isa});
        if (rays_.empty()) return;
        brute_force_rays();
        for (const Walked& walked : walked_) serial_rays(walked);
        for (auto& [name, tracer] : tracers_) {
            listener_.stage(name + " rays", seconds_allowed());
            compare(name + " rays", tracer.closest_hits(rays_));
        }
    }

  private:
    double pixels() const { return static_cast<double>(resolution_.width) * resolution_.height; }

    bool too_much_for_brute_force() const {
        const double items = static_cast<double>(primitives_.item_count());
        const double lights = static_cast<double>(scene_.lights.size());
        return items * pixels() * (1 + lights) > kMostTests;
    }
    void brute_force() {
        if (too_much_for_brute_force()) return;
        listener_.stage("brute force", kPatience * seconds_allowed());
        compare("brute force",
                render_brute_force(scene_, primitives_, exact_profile(), resolution_));
    }
    void brute_force_rays() {
        if (too_much_for_brute_force()) return;
        listener_.stage("brute force rays", kPatience * seconds_allowed());
        compare("brute force rays",
                closest_hits(scene_, primitives_, nullptr, exact_profile(), rays_));
    }

    // An octree and the profile that asked for it.
    struct Walked {
        std::string name;
        Profile profile;
        Octree octree;
    };

    void serial(const SerialWay& way) {
        const std::string name = way.name;
        Profile profile = exact_profile();
        profile.type = way.type;
        profile.midpoint = way.midpoint;
        listener_.stage(name, seconds_allowed());
        const double begin = processor_seconds();
        const Octree& octree =
            walked_.emplace_back(Walked{name, profile, build_tree(scene_, primitives_, profile)})
                .octree;
        const double built = processor_seconds();
        compare(name, render(scene_, primitives_, octree, profile, resolution_));
        if (slow(built - begin, processor_seconds() - built)) {
            listener_.stage(name + " at 160x90", seconds_allowed() - (built - begin));
            render(scene_, primitives_, octree, profile, kTimed);
        }
        profile.walk = WalkChoice::kDescent;
        listener_.stage(name + " descent", seconds_allowed());
        compare(name + " descent", render(scene_, primitives_, octree, profile, resolution_));
    }
    void serial_rays(const Walked& walked) {
        Profile profile = walked.profile;
        for (const WalkChoice walk : {WalkChoice::kHash, WalkChoice::kDescent}) {
            profile.walk = walk;
            const std::string name =
                walked.name + (walk == WalkChoice::kHash ? " rays" : " descent rays");
            listener_.stage(name, seconds_allowed());
            compare(name, closest_hits(scene_, primitives_, &walked.octree, profile, rays_));
        }
    }

    void fast(const FastOptions& options) {
        const std::string name = fast_name(options);
        listener_.stage(name, seconds_allowed());
        const double begin = processor_seconds();
        FastTracer tracer(scene_, primitives_, options);
        const double built = processor_seconds();
        compare(name, tracer.render(resolution_));
        if (options.threads != 1) return;
        // The instruction sets do the same work.
        if (options.isa == supported_instruction_sets().front() &&
            slow(built - begin, processor_seconds() - built)) {
            listener_.stage(name + " at 160x90", seconds_allowed() - (built - begin));
            tracer.render(kTimed);
        }
        tracers_.emplace_back(name, std::move(tracer));
    }

    // Whether 160 x 90 pixels might take too long, judged by those that were made; of few pixels
    // most time is in what a picture costs whatever its size.
    bool slow(double build, double trace) const {
        const double timed = static_cast<double>(kTimed.width) * kTimed.height;
        return pixels() >= 100 && build + trace * timed / pixels() > seconds_allowed() / 2;
    }

    void compare(const std::string& name, Image image) {
        listener_.ran();
        if (!expected_) {
            expected_ = std::move(image);
            return;
        }
        if (const auto found = difference(*expected_, image))
            listener_.found({"difference: " + name, name + ": " + *found});
    }

    void compare(const std::string& name, std::vector<RayAnswer> answers) {
        listener_.ran();
        for (std::size_t i = 0; i < answers.size(); ++i)
            if (std::isnan(answers[i].t)) {
                listener_.found({"not finite: " + name, name + ": t of ray " + std::to_string(i)});
                return;
            }
        if (!expected_answers_) {
            expected_answers_ = std::move(answers);
            return;
        }
        for (std::size_t i = 0; i < answers.size(); ++i) {
            const RayAnswer& expected = (*expected_answers_)[i];
            if (same(expected, answers[i])) continue;
            listener_.found({"difference: " + name, name + ": ray " + std::to_string(i) + ": " +
                                                        text(answers[i]) + " instead of " +
                                                        text(expected)});
            return;
        }
    }

    const Scene& scene_;
    Resolution resolution_;
    bool fast_;
    const Listener& listener_;
    Primitives primitives_;
    std::vector<Ray> rays_;
    std::deque<Walked> walked_;
    std::deque<std::pair<std::string, FastTracer>> tracers_;
    std::optional<Image> expected_;  // the first pipeline's
    std::optional<std::vector<RayAnswer>> expected_answers_;
};

bool finite(const Vector3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool finite(const Shape& shape) {
    if (const auto* sphere = std::get_if<Sphere>(&shape))
        return finite(sphere->center) && std::isfinite(sphere->radius);
    if (const auto* ellipsoid = std::get_if<Ellipsoid>(&shape))
        return finite(ellipsoid->center) && std::isfinite(ellipsoid->radius) &&
               std::all_of(ellipsoid->linear.row, ellipsoid->linear.row + 3,
                           [](const Vector3& row) { return finite(row); });
    const auto& mesh = std::get<TriangleMesh>(shape);
    const auto all = [](const auto& list) {
        return std::all_of(list.begin(), list.end(), [](const Vector3& v) { return finite(v); });
    };
    return all(mesh.positions) && all(mesh.normals) && all(mesh.colors);
}

bool finite(const Light& light) {
    return finite(light.location) && finite(light.direction) && finite(light.attenuation) &&
           std::isfinite(light.units_per_world) && !std::isnan(light.radius);
}

}  // namespace

double seconds_allowed() {
#if defined(NUVO_SANITIZED)
    return 40;
#elif defined(NDEBUG)
    return 2;
#else
    return 20;
#endif
}

void check(const Scene& scene, const Document& document, const Listener& listener) {
    const bool all_finite =
        finite(scene.camera.position) && finite(scene.camera.forward) &&
        std::all_of(scene.objects.begin(), scene.objects.end(),
                    [](const Object& object) { return finite(object.shape); }) &&
        std::all_of(scene.lights.begin(), scene.lights.end(),
                    [](const Light& light) { return finite(light); });
    if (!all_finite) listener.found({"not finite: loader", "the loader hands over such numbers"});
    Checker(scene, document, listener).run();
}

}  // namespace nuvo::fuzz
