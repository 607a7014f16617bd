#include "bytes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "chooser.h"
#include "nuvo/app/options.h"
#include "nuvo/app/rays.h"
#include "nuvo/render/primitives.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::fuzz {
namespace {

namespace fs = std::filesystem;

// A refusal is one line that says something.
void expect_line(const std::string& message) {
    if (message.empty() || message.find('\n') != std::string::npos)
        throw std::logic_error("a message of no or many lines: " + message);
}

bool finite(const Vector3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::string mutation_word(Chooser& choose, const Target& target) {
    if (choose.once_in(4)) return text(choose.signed_magnitude());
    const int n = static_cast<int>(target.words.size());
    return target.words[static_cast<std::size_t>(choose.below(n))];
}

void take_scene(std::string_view bytes, bool strict) {
    x3d::Limits limits;  // small ones, so that time goes into variety
    limits.depth = 200;
    limits.elements = 2000;
    limits.attributes = 2000;
    limits.shapes = 200;
    limits.vertices = 20'000;
    limits.file_bytes = 1'000'000;
    try {
        const Scene scene =
            x3d::read_text(std::string(bytes), "fuzz", {.limits = limits, .strict = strict});
        const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
        for (const Bounds3& box : primitives.item_boxes)
            if (!finite(box.min) || !finite(box.max))
                throw std::logic_error("a shape that is not finite");
        for (const std::string& warning : scene.warnings) expect_line(warning);
    } catch (const x3d::Error& error) {
        expect_line(error.what());
    }
}

}  // namespace

void take_scene(std::string_view bytes) {
    for (const bool strict : {false, true}) take_scene(bytes, strict);
}

void take_rays(std::string_view bytes) {
    try {
        for (const Ray& ray : app::parse_rays(bytes, "fuzz"))
            if (!finite(ray.origin) || !finite(ray.direction) || ray.direction == Vector3{})
                throw std::logic_error("a ray that is none");
    } catch (const app::RaysError& error) {
        expect_line(error.what());
    }
}

void take_options(std::string_view bytes) {
    std::vector<std::string> arguments;
    while (!bytes.empty()) {
        // An argument cannot hold a zero byte.
        const std::size_t end =
            std::min(bytes.find_first_of(std::string_view("\n\0", 2)), bytes.size());
        arguments.emplace_back(bytes.substr(0, end));
        bytes.remove_prefix(std::min(end + 1, bytes.size()));
    }
    try {
        app::parse(arguments);
    } catch (const app::UsageError& error) {
        if (*error.what() == '\0') throw std::logic_error("a refusal without a word");
    }
}

const std::vector<Target>& targets() {
    static const std::vector<Target> all{
        {"scene",
         take_scene,
         {"<Transform ",
          "</Transform>",
          "<Shape>",
          "</Shape>",
          "<Sphere radius='",
          "<Box size='",
          "<Cone/>",
          "<Cylinder/>",
          "<Group DEF='a'>",
          "<Group USE='a'/>",
          "</Group>",
          "'/>",
          "'>",
          "scale='",
          "translation='",
          "rotation='",
          "coordIndex='",
          "<IndexedFaceSet ",
          "<IndexedTriangleSet index='",
          "<ElevationGrid xDimension='2' zDimension='2' height='",
          "<Coordinate point='",
          "<Color color='",
          "<Normal vector='",
          "creaseAngle='1' ",
          "convex='false' ",
          "normalPerVertex='false' ",
          "<Switch whichChoice='0'>",
          "<LOD range='",
          "<Inline url='",
          "<!--",
          "-->",
          "<![CDATA[",
          "]]>",
          "<?x ?>",
          "<!DOCTYPE X3D [",
          "]>",
          "&amp;",
          "&#0;",
          "&#x110000;",
          "\xef\xbb\xbf",
          "\xff\xfe",
          "\x1f\x8b",
          "0 1 2 -1",
          "nan",
          "<PointLight/>",
          "<SpotLight cutOffAngle='",
          "<Viewpoint fieldOfView='",
          "<ProtoDeclare>",
          "version='3.0'",
          "<Scene>",
          "</Scene>",
          "<X3D>",
          "</X3D>"}},
        {"rays",
         take_rays,
         {" ", "\n", "\r\n", "\t", "0", "-0", "1e400", "1e-400", "nan", "inf", "+1", ".5", "1.",
          "0x1p3", "#", ",", "0 0 10 0 0 -1\n"}},
        {"options",
         take_options,
         {"--file=",    "--res=",     "1,1",      "\n",      "--rep=",  "--type=",    "uniform",
          "nonuniform", "-compare",   "-h",       "--",      "-",       "--profile=", "exact",
          "fast",       "thesis",     "--walk=",  "hash",    "--step=", "--bias=",    "=",
          "--costs=",   "calibrated", "thesis:8", "--isa=",  "avx2",    "--threads=", "--midpoint=",
          "published",  "--rays=",    "--out=",   "--json=", "--study", "-showoctree"}},
    };
    return all;
}

std::vector<std::string> corpus_of(const Target& target) {
    std::vector<fs::path> paths;
    for (const auto& entry :
         fs::directory_iterator(fs::path(NUVO_SOURCE_DIR) / "tests/fuzz/corpus" / target.name))
        paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::vector<std::string> corpus;
    for (const fs::path& path : paths) {
        std::ifstream in(path, std::ios::binary);
        corpus.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    return corpus;
}

std::string mutated(const std::vector<std::string>& corpus, const Target& target,
                    std::uint64_t seed) {
    Chooser choose(seed);
    const auto any = [&]() -> const std::string& {
        return corpus[static_cast<std::size_t>(choose.below(static_cast<int>(corpus.size())))];
    };
    std::string bytes = any();
    for (int i = 1 + choose.below(4); i > 0; --i) {
        const auto place = [&] {
            return static_cast<std::size_t>(choose.below(static_cast<int>(bytes.size()) + 1));
        };
        const std::size_t begin = place();
        const auto length = static_cast<std::size_t>(1 + choose.below(choose.once_in(3) ? 100 : 6));
        switch (choose.below(6)) {
            case 0:
                bytes.erase(begin, length);
                break;
            case 1:
                bytes.insert(place(), bytes.substr(begin, length));
                break;
            case 2: {  // the end of another
                const std::string& other = any();
                bytes = bytes.substr(0, begin) + other.substr(std::min(begin, other.size()));
                break;
            }
            case 3:
                if (begin < bytes.size()) bytes[begin] = static_cast<char>(choose.below(256));
                break;
            case 4:
                bytes.replace(begin, length, mutation_word(choose, target));
                break;
            default:
                bytes.insert(begin, mutation_word(choose, target));
        }
    }
    return bytes;
}

}  // namespace nuvo::fuzz
