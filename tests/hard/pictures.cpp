#include "pictures.h"

#include <algorithm>
#include <cstdlib>
#include <iomanip>
#include <mutex>
#include <ostream>
#include <sstream>

#include "nuvo/math/parallel.h"
#include "nuvo/render/fast.h"
#include "nuvo/render/render.h"
#include "nuvo/scene/x3d.h"
#include "reference.h"
#include "scene_files.h"
#include "threads.h"

namespace nuvo::hard {
namespace {

int distance(const Rgb8& a, const Rgb8& b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

std::string text(const Rgb8& c) {
    std::ostringstream out;
    out << +c.r << "," << +c.g << "," << +c.b;
    return out.str();
}

}  // namespace

std::string hard_scene_path(const std::string& name) {
    return std::string(NUVO_SOURCE_DIR) + "/testfiles/hard/" + name + ".x3d";
}

Image picture(const Scene& scene, Resolution resolution) {
    Profile profile = exact_profile();
    profile.type = OctreeType::kNonuniform;
    const Primitives primitives = flatten(scene, profile.leaves);
    return render(scene, primitives, build_tree(scene, primitives, profile), profile, resolution);
}

int fast_differences(const Scene& scene, const Image& exact) {
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    int differing = 0;
    for (const OctreeType type : {OctreeType::kUniform, OctreeType::kNonuniform})
        for (const InstructionSet isa : supported_instruction_sets()) {
            FastOptions options;
            options.type = type;
            options.isa = isa;
            FastTracer tracer(scene, primitives, options);
            const Image image = tracer.render({exact.width(), exact.height()});
            for (std::size_t i = 0; i < exact.pixels().size(); ++i)
                differing += image.pixels()[i] == exact.pixels()[i] ? 0 : 1;
        }
    return differing;
}

PictureCheck check_picture(const Scene& scene, const Image& image, std::ostream& faults,
                           bool rounded_points) {
    const Reference reference(scene, {image.width(), image.height()});
    PictureCheck check;
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            ++check.pixels;
            const Reference::Sample truth = reference.pixel(x, y);
            if (distance(truth.color, image.at(x, y)) <= 1) continue;
            ++check.off;
            if (!reference.stable(x, y)) {
                ++check.masked;
                continue;
            }
            if (rounded_points && !reference.stable_when_rounded(x, y)) {
                ++check.rounded;
                continue;
            }
            faults << "pixel " << x << "," << y << ": " << text(image.at(x, y)) << " instead of "
                   << text(truth.color) << ", shape " << truth.object << " triangle "
                   << truth.triangle << " lit " << truth.lit << "\n";
        }
    }
    return check;
}

bool check_pictures(Resolution resolution, unsigned threads, std::ostream& out) {
    const std::vector<SceneFile> files = hard_scene_files();
    std::vector<PictureCheck> checks(files.size());
    std::vector<std::string> faults(files.size());
    for_each_index(thread_count(threads), files.size(), [&](std::size_t i, int) {
        const Scene scene = x3d::read_file(hard_scene_path(files[i].name));
        std::ostringstream found;
        const Image image = picture(scene, resolution);
        checks[i] = check_picture(scene, image, found);
        checks[i].fast_differs = fast_differences(scene, image);
        faults[i] = found.str();
    });
    out << "| testfiles/hard           | pixels | off, on the mask | off elsewhere | fast differs "
           "|\n"
           "|---|---|---|---|---|\n";
    bool right = true;
    for (std::size_t i = 0; i < files.size(); ++i) {
        out << faults[i] << "| " << std::left << std::setw(24) << files[i].name << std::right
            << " | " << std::setw(6) << checks[i].pixels << " | " << std::setw(16)
            << checks[i].masked << " | " << std::setw(13) << checks[i].wrong() << " | "
            << std::setw(12) << checks[i].fast_differs << " |\n";
        right = right && checks[i].wrong() == 0 && checks[i].fast_differs == 0;
    }
    return right;
}

}  // namespace nuvo::hard
