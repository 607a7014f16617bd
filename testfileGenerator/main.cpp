#include <algorithm>
#include <charconv>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scenes.h"

namespace nuvo::generator {
namespace {

constexpr int kExitOk = 0;
constexpr int kExitUsage = 2;
constexpr int kExitCannotWrite = 4;

constexpr std::string_view kUsage =
    "usage: testfile_generator NAME [option]... [--out=FILE]   one scene, to FILE or standard "
    "output\n"
    "       testfile_generator --all --out=DIR [--seed=N]      the test files, to DIR/NAME.x3d\n"
    "       testfile_generator --list                          the scenes\n"
    "       testfile_generator -h                              this text\n"
    "  --seed=N           a whole number below 2^64 (2); the same seed gives the same bytes\n"
    "  --camera=far|near  teapot, tests 1 to 4, octahedra, spheres: where the scene fits the\n"
    "                     picture's height, or at 0.3 of that distance\n"
    "  --count=N          octahedra, spheres: how many (1 to 10,000,000)\n";

constexpr int kMaxCount = 10'000'000;

/// The command line is wrong: the text says how.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A file could not be written: the text says which.
struct WriteError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Request {
    bool help = false;
    bool list = false;
    bool all = false;
    Variation variation;
    std::optional<std::string> name;
    std::optional<std::string> out;
};

std::uint64_t parse_seed(std::string_view text) {
    std::uint64_t seed = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
    if (error != std::errc() || end != text.data() + text.size()) {
        throw UsageError("--seed=" + std::string(text) + ": not a whole number from 0 to 2^64 - 1");
    }
    return seed;
}

int parse_number(std::string_view option, std::string_view text, int most) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 1 || value > most) {
        throw UsageError(std::string(option) + std::string(text) +
                         ": not a whole number from 1 to " + std::to_string(most));
    }
    return value;
}

CameraPlace parse_camera(std::string_view text) {
    if (text == "far") return CameraPlace::kFar;
    if (text == "near") return CameraPlace::kNear;
    throw UsageError("--camera=" + std::string(text) + ": neither far nor near");
}

/// Takes an option that changes scenes; false where it is none.
bool parse_variation(std::string_view argument, Variation& variation) {
    constexpr std::string_view kSeed = "--seed=";
    constexpr std::string_view kCamera = "--camera=";
    constexpr std::string_view kCount = "--count=";
    if (argument.starts_with(kSeed)) {
        variation.seed = parse_seed(argument.substr(kSeed.size()));
    } else if (argument.starts_with(kCamera)) {
        variation.camera = parse_camera(argument.substr(kCamera.size()));
    } else if (argument.starts_with(kCount)) {
        variation.count = parse_number(kCount, argument.substr(kCount.size()), kMaxCount);
    } else {
        return false;
    }
    return true;
}

/// An option must mean something to the scene that is asked for; --all takes the seed only.
void check_variation(const Variation& variation, const std::string& name, const Takes& takes) {
    if (variation.camera != CameraPlace::kOwn && !takes.camera)
        throw UsageError(name + " takes no --camera");
    if (variation.count != 0 && !takes.count) throw UsageError(name + " takes no --count");
    if (variation.count == 0 && takes.count) throw UsageError(name + " needs --count=N");
}

Request parse(const std::vector<std::string_view>& arguments) {
    Request request;
    for (const std::string_view argument : arguments) {
        if (argument == "-h" || argument == "--help") {
            request.help = true;
        } else if (argument == "--list") {
            request.list = true;
        } else if (argument == "--all") {
            request.all = true;
        } else if (parse_variation(argument, request.variation)) {
            continue;
        } else if (argument.starts_with("--out=")) {
            request.out = argument.substr(6);
        } else if (argument.starts_with("-")) {
            throw UsageError("unknown option " + std::string(argument));
        } else if (request.name) {
            throw UsageError("two scenes: " + *request.name + " and " + std::string(argument));
        } else {
            request.name = argument;
        }
    }
    if (request.help) return request;
    if (request.list + request.all + request.name.has_value() != 1) {
        throw UsageError("give the name of one scene, --all or --list");
    }
    if (request.all && !request.out) throw UsageError("--all needs --out=DIR");
    if (request.list && request.out) throw UsageError("--list takes no --out");
    if (request.all) check_variation(request.variation, "--all", {});
    if (request.list) check_variation(request.variation, "--list", {});
    if (request.out && request.out->empty()) throw UsageError("--out= needs a name");
    return request;
}

const Scene& find_scene(const std::string& name) {
    const auto scenes = all_scenes();
    const auto found = std::ranges::find(scenes, name, &Scene::name);
    if (found == scenes.end()) throw UsageError("no scene is called " + name + "; see --list");
    return *found;
}

void write_file(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    if (!file) throw WriteError(path.string() + ": cannot be opened for writing");
    file << text << std::flush;
    if (!file) throw WriteError(path.string() + ": cannot be written");
}

void write_standard_output(std::string_view text) {
    std::cout << text << std::flush;
    if (!std::cout) throw WriteError("standard output: cannot be written");
}

std::string list_text() {
    std::string out;
    for (const Scene& scene : all_scenes()) {
        out += std::string(scene.name) + std::string(14 - scene.name.size(), ' ') +
               std::string(scene.summary) + "\n";
    }
    return out;
}

void run(const Request& request) {
    if (request.help) {
        write_standard_output(kUsage);
    } else if (request.list) {
        write_standard_output(list_text());
    } else if (request.all) {
        std::error_code ignored;  // what matters is whether the files can be written
        std::filesystem::create_directories(*request.out, ignored);
        for (const Scene& scene : all_scenes()) {
            if (scene.takes.count) continue;
            const auto file =
                std::filesystem::path(*request.out) / (std::string(scene.name) + ".x3d");
            write_file(file, scene.write(request.variation));
        }
    } else {
        const Scene& scene = find_scene(*request.name);
        check_variation(request.variation, *request.name, scene.takes);
        const std::string text = scene.write(request.variation);
        if (request.out) {
            write_file(*request.out, text);
        } else {
            write_standard_output(text);
        }
    }
}

}  // namespace
}  // namespace nuvo::generator

int main(int argc, char** argv) {
    using namespace nuvo::generator;
    try {
        run(parse(std::vector<std::string_view>(argv + std::min(argc, 1), argv + argc)));
        return kExitOk;
    } catch (const UsageError& error) {
        std::cerr << "testfile_generator: " << error.what() << "\n" << kUsage;
        return kExitUsage;
    } catch (const std::exception& error) {
        std::cerr << "testfile_generator: " << error.what() << "\n";
        return kExitCannotWrite;
    }
}
