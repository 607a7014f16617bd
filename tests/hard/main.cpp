#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include "classes.h"
#include "leaks.h"
#include "pictures.h"
#include "run.h"
#include "scene_files.h"

namespace {

constexpr const char* kUsage =
    "usage: hard_cases [flag]...\n"
    "  --rays=N       rays against exact arithmetic, over all classes (1000000)\n"
    "  --seed=S       any number (1)\n"
    "  --class=NAME   one class only\n"
    "  --leaks=N      instead: rays from inside closed meshes at their corners and edges\n"
    "  --pictures     instead: pictures of testfiles/hard against the reference, 160 x 90\n"
    "  --scenes=N     instead: N scenes of the classes, lit from hard places, against the "
    "reference\n"
    "  --fast         with --rays: by the fast tracer's single rays\n"
    "  --solid        with --rays: of every other shape only the front is there\n"
    "  --precision=P  exact, double or float tests, to see the oracle find their errors (exact)\n"
    "  --lit=N        instead: N scenes with every kind of light and material against the "
    "reference\n"
    "  --write-scenes instead: write testfiles/hard anew\n"
    "  --threads=N    batches at once (as many as the machine has)\n"
    "  --list         the classes\n";

struct Flags {
    nuvo::hard::RunOptions run;
    std::uint64_t leaks = 0;
    std::uint64_t scenes = 0;
    std::uint64_t lit = 0;
    bool list = false;
    bool pictures = false;
    bool write_scenes = false;
    bool help = false;
};

bool read_number(const std::string& text, std::uint64_t& number) {
    if (text.empty() || text.find_first_not_of("0123456789") != std::string::npos) return false;
    number = std::strtoull(text.c_str(), nullptr, 10);
    return true;
}

bool read_flag(const std::string& flag, Flags& flags) {
    const std::size_t equals = flag.find('=');
    const std::string name = flag.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : flag.substr(equals + 1);
    std::uint64_t number = 0;
    if (name == "--list") return flags.list = true;
    if (name == "--pictures") return flags.pictures = true;
    if (name == "--fast") return flags.run.fast = true;
    if (name == "--solid") return flags.run.solid = true;
    if (name == "--write-scenes") return flags.write_scenes = true;
    if (name == "--help" || name == "-h") return flags.help = true;
    if (name == "--class") {
        flags.run.only = value;
        return true;
    }
    if (name == "--precision") {
        using nuvo::Precision;
        flags.run.precision = value == "float"    ? Precision::kFloat
                              : value == "double" ? Precision::kDouble
                                                  : Precision::kExact;
        return value == "float" || value == "double" || value == "exact";
    }
    if (!read_number(value, number)) return false;
    if (name == "--rays")
        flags.run.rays = number;
    else if (name == "--seed")
        flags.run.seed = number;
    else if (name == "--leaks")
        flags.leaks = number;
    else if (name == "--scenes")
        flags.scenes = number;
    else if (name == "--lit")
        flags.lit = number;
    else if (name == "--threads")
        flags.run.threads = static_cast<unsigned>(number);
    else
        return false;
    return true;
}

void write_scenes() {
    for (const nuvo::hard::SceneFile& file : nuvo::hard::hard_scene_files()) {
        const std::filesystem::path path = nuvo::hard::hard_scene_path(file.name);
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path, std::ios::binary) << file.text;
    }
}

int count_and_print_leaks(const Flags& flags) {
    const nuvo::hard::LeakCount count =
        nuvo::hard::count_leaks(flags.leaks, flags.run.seed, flags.run.threads, std::cerr);
    std::cout << count.leaks << " leaks of " << count.rays << " rays, seed " << flags.run.seed
              << "\n";
    return count.leaks == 0 ? 0 : 1;
}

}  // namespace

// 0: all is right; 1: something is wrong; 2: bad command line.
int main(int argc, char** argv) {
    using namespace nuvo::hard;
    Flags flags;
    for (int i = 1; i < argc; ++i) {
        if (!read_flag(argv[i], flags)) {
            std::cerr << "hard_cases: " << argv[i] << "\n" << kUsage;
            return 2;
        }
    }
    if (flags.help) {
        std::cout << kUsage;
        return 0;
    }
    if (flags.list) {
        for (const HardClass& hard_class : hard_classes()) std::cout << hard_class.name << "\n";
        return 0;
    }
    if (flags.write_scenes) {
        write_scenes();
        return 0;
    }
    if (flags.pictures) return check_pictures({160, 90}, flags.run.threads, std::cout) ? 0 : 1;
    if (flags.scenes > 0)
        return check_random_pictures(flags.scenes, flags.run.seed, flags.run.threads, std::cout)
                   ? 0
                   : 1;
    if (flags.lit > 0)
        return check_random_pictures(flags.lit, flags.run.seed, flags.run.threads, std::cout,
                                     Lighting::kRich)
                   ? 0
                   : 1;
    if (flags.leaks > 0) return count_and_print_leaks(flags);
    const std::vector<ClassTally> tallies = run(flags.run, std::cerr);
    if (tallies.empty()) {
        std::cerr << "hard_cases: no class " << flags.run.only << " (--list names them)\n";
        return 2;
    }
    const bool right = print(std::cout, tallies);
    std::cout << (right ? "all right" : "WRONG") << ", seed " << flags.run.seed << "\n";
    return right ? 0 : 1;
}
