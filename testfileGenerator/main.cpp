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
    "usage: testfile_generator NAME [--seed=N] [--out=FILE]   one scene, to FILE or standard "
    "output\n"
    "       testfile_generator --all --out=DIR [--seed=N]     every scene, to DIR/NAME.x3d\n"
    "       testfile_generator --list                         the scenes\n"
    "       testfile_generator -h                             this text\n"
    "The same seed (a whole number below 2^64, 2 unless given) gives the same bytes everywhere.\n";

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
    std::uint64_t seed = kDefaultSeed;
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

Request parse(const std::vector<std::string_view>& arguments) {
    Request request;
    for (const std::string_view argument : arguments) {
        if (argument == "-h" || argument == "--help") {
            request.help = true;
        } else if (argument == "--list") {
            request.list = true;
        } else if (argument == "--all") {
            request.all = true;
        } else if (argument.starts_with("--seed=")) {
            request.seed = parse_seed(argument.substr(7));
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
            const auto file =
                std::filesystem::path(*request.out) / (std::string(scene.name) + ".x3d");
            write_file(file, scene.write(request.seed));
        }
    } else {
        const std::string text = find_scene(*request.name).write(request.seed);
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
