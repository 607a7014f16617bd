// Random documents through every pipeline: scene_fuzz [--minutes=M | --scenes=N | --scene=I]
// [--seed=S]
// [--results=FOLDER] [--jobs=J] [--trials=T] [--no-fast] [--no-rays] [FILE]... Files are checked in
// place of random documents. The exit status is 1 where anything was found.
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "grammar.h"
#include "isolated.h"
#include "minimize.h"

namespace {

using namespace nuvo::fuzz;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Options {
    double minutes = 1;
    std::uint64_t scenes = 0;  // 0: until the minutes are over
    std::uint64_t first = 0;   // scene
    std::uint64_t seed = 1;
    unsigned jobs = 1;
    int trials = 1500;    // of a minimization
    int files_a_key = 2;  // equal keys beyond that are only counted
    fs::path results = "fuzz-results";
    bool fast = true;
    bool rays = true;
    std::vector<fs::path> files;
};

bool read(const std::string& argument, Options& options) {
    const auto value = [&](const char* flag) -> const char* {
        const std::string start = std::string(flag) + "=";
        return argument.rfind(start, 0) == 0 ? argument.c_str() + start.size() : nullptr;
    };
    if (const char* minutes = value("--minutes"))
        options.minutes = std::atof(minutes);
    else if (const char* scenes = value("--scenes"))
        options.scenes = std::strtoull(scenes, nullptr, 10);
    else if (const char* scene = value("--scene")) {
        options.first = std::strtoull(scene, nullptr, 10);
        options.scenes = options.first + 1;
    } else if (const char* seed = value("--seed"))
        options.seed = std::strtoull(seed, nullptr, 10);
    else if (const char* jobs = value("--jobs"))
        options.jobs = static_cast<unsigned>(std::atoi(jobs));
    else if (const char* trials = value("--trials"))
        options.trials = std::atoi(trials);
    else if (const char* results = value("--results"))
        options.results = results;
    else if (argument == "--no-fast")
        options.fast = false;
    else if (argument == "--no-rays")
        options.rays = false;
    else if (argument.rfind("-", 0) == 0)
        return false;
    else
        options.files.emplace_back(argument);
    return true;
}

struct Totals {
    std::uint64_t scenes = 0;
    std::uint64_t refused = 0;
    std::uint64_t runs = 0;
    std::uint64_t findings = 0;  // scenes with any
};

std::string file_name(const std::string& key, std::uint64_t scene) {
    std::string name = key + "-" + std::to_string(scene);
    for (char& c : name)
        if (c == ' ' || c == ':') c = '-';
    return name;
}

// Makes the finding small and writes it, with all that was found of it.
void report(const Options& options, const Document& document, std::uint64_t scene,
            const std::string& key, const fs::path& scratch) {
    const auto first_key = [&](const Document& d) {
        const Verdict verdict = judge(d, scratch);
        return verdict.findings.empty() ? std::string() : verdict.findings[0].key;
    };
    // Trials that end by the time allowed are dear.
    const int trials = key.rfind("time", 0) == 0 ? options.trials / 20 : options.trials;
    const Document small = minimized(
        document, [&](const Document& d) { return first_key(d) == key; }, trials);
    const fs::path path = options.results / (file_name(key, scene) + ".x3d");
    write(small, path);
    std::ofstream log(path.string() + ".txt");
    log << "seed " << options.seed << " scene " << scene << "\n";
    for (const Finding& finding : judge(small, scratch).findings) log << finding.text << "\n";
    std::cout << path.string() << std::endl;
}

// Every jobs-th scene from `job` on.
Totals fuzz(const Options& options, unsigned job) {
    const fs::path scratch = options.results / ("scratch-" + std::to_string(job));
    fs::create_directories(scratch);
    const auto end = Clock::now() + std::chrono::duration<double>(60 * options.minutes);
    std::map<std::string, int> keys;
    Totals totals;
    for (std::uint64_t i = options.first + job;
         options.scenes > 0 ? i < options.scenes : Clock::now() < end; i += options.jobs) {
        const std::uint64_t number = options.seed * 1'000'000'000 + i;
        Document document = make_document(number);
        document.fast = options.fast;
        if (!options.rays) document.rays.clear();
        const Verdict verdict = judge(document, scratch);
        ++totals.scenes;
        totals.refused += verdict.refused ? 1 : 0;
        totals.runs += static_cast<std::uint64_t>(verdict.runs);
        if (verdict.findings.empty()) continue;
        ++totals.findings;
        const Finding& first = verdict.findings[0];
        std::cout << "scene " << i << ": " << first.text << std::endl;
        if (++keys[first.key] <= options.files_a_key)
            report(options, document, i, first.key, scratch);
    }
    for (const auto& [key, count] : keys) std::cout << count << " x " << key << std::endl;
    fs::remove_all(scratch);
    return totals;
}

// Jobs are processes, as each must have one thread only.
Totals fuzz_in_jobs(const Options& options) {
    std::vector<std::pair<pid_t, int>> children;
    for (unsigned job = 1; job < options.jobs; ++job) {
        int ends[2];
        if (::pipe(ends) != 0) break;
        const pid_t child = ::fork();
        if (child == 0) {
            const Totals totals = fuzz(options, job);
            const ssize_t written = ::write(ends[1], &totals, sizeof totals);
            ::_exit(written == sizeof totals ? 0 : 1);
        }
        ::close(ends[1]);
        children.emplace_back(child, ends[0]);
    }
    Totals sum = fuzz(options, 0);
    for (const auto& [child, pipe] : children) {
        Totals totals;
        if (::read(pipe, &totals, sizeof totals) == sizeof totals) {
            sum.scenes += totals.scenes;
            sum.refused += totals.refused;
            sum.runs += totals.runs;
            sum.findings += totals.findings;
        }
        ::waitpid(child, nullptr, 0);
    }
    return sum;
}

int check_files(const Options& options) {
    int wrong = 0;
    for (const fs::path& file : options.files) {
        const Verdict verdict = judge_file(file);
        if (verdict.refused) std::cout << verdict.refusal << "\n";
        if (!verdict.findings.empty())
            std::cout << file.string() << ": " << verdict.findings[0].text << " (and "
                      << verdict.findings.size() - 1 << " more)\n";
        wrong += verdict.findings.empty() ? 0 : 1;
    }
    std::cout << options.files.size() << " files, " << wrong << " with findings" << std::endl;
    return wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i)
        if (!read(argv[i], options)) {
            std::cerr << "scene_fuzz: unknown flag " << argv[i] << "\n";
            return 2;
        }
    if (!options.files.empty()) return check_files(options);
    fs::create_directories(options.results);
    const Totals totals = fuzz_in_jobs(options);
    std::cout << totals.scenes << " scenes (" << totals.refused << " refused), " << totals.runs
              << " pipeline runs, " << totals.findings << " scenes with findings, seed "
              << options.seed << std::endl;
    return totals.findings == 0 ? 0 : 1;
}
