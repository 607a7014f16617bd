#include "isolated.h"

#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <new>
#include <sstream>

#include "nuvo/scene/x3d.h"

namespace nuvo::fuzz {
namespace {

// The child's lines to its parent: a letter for what, then the text; two texts end by tabs.
constexpr char kStage = 's', kFound = 'f', kRan = 'r', kRefused = 'x', kDone = 'd';

void tell(int pipe, char what, const std::string& text = {}) {
    const std::string line = what + text + "\n";
    const ssize_t written = ::write(pipe, line.data(), line.size());
    static_cast<void>(written);  // the parent is gone, and soon so are we
}

// From now on that much processor time, of all threads.
void allow(double seconds) {
    const double whole = std::floor(seconds);
    itimerval timer{};
    timer.it_value.tv_sec = static_cast<time_t>(whole);
    timer.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (seconds - whole)) + 1;
    ::setitimer(ITIMER_PROF, &timer, nullptr);
}

void limit_memory() {
#if !defined(NUVO_SANITIZED)  // which reserves more than any limit
    constexpr rlim_t kBytes = 4'000'000'000;
    const rlimit memory{kBytes, kBytes};
    ::setrlimit(RLIMIT_AS, &memory);
#endif
}

using Load = std::function<Scene(Document&)>;

void work(int pipe, const Load& load) {
    std::string name;
    const Listener listener{
        [&](const std::string& stage, double seconds) {
            name = stage;
            tell(pipe, kStage, stage);
            allow(seconds);
        },
        [&](const Finding& finding) { tell(pipe, kFound, finding.key + "\t" + finding.text); },
        [&] { tell(pipe, kRan); }};
    try {
        listener.stage("loader", seconds_allowed());
        Document document;
        const Scene scene = load(document);
        check(scene, document, listener);
    } catch (const x3d::Error& error) {
        tell(pipe, kRefused, error.what());
    } catch (const std::bad_alloc&) {
        tell(pipe, kFound, "memory: " + name + "\t" + name + ": over 4 GB");
    } catch (const std::exception& error) {
        tell(pipe, kFound, "exception: " + name + "\t" + name + ": " + error.what());
    }
    tell(pipe, kDone);
}

// What the lines say, and how the process ended.
Verdict read(const std::string& lines, int status) {
    Verdict verdict;
    std::istringstream in(lines);
    std::string stage;
    bool done = false;
    for (std::string line; std::getline(in, line);) {
        if (line.empty()) continue;
        const std::string rest = line.substr(1);
        const std::size_t tab = rest.find('\t');
        if (line[0] == kStage) stage = rest;
        if (line[0] == kRan) ++verdict.runs;
        if (line[0] == kDone) done = true;
        if (line[0] == kRefused) {
            verdict.refused = true;
            verdict.refusal = rest;
        }
        if (line[0] == kFound && tab != std::string::npos)
            verdict.findings.push_back({rest.substr(0, tab), rest.substr(tab + 1)});
    }
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF)
        verdict.findings.push_back(
            {"time: " + stage, stage + ": more processor time than allowed"});
    else if (WIFSIGNALED(status))
        verdict.findings.push_back(
            {"crash: " + stage, stage + ": ended by " + ::strsignal(WTERMSIG(status))});
    else if (!done)
        verdict.findings.push_back({"crash: " + stage, stage + ": ended by itself"});
    return verdict;
}

Verdict judge(const Load& load) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
    const pid_t child = ::fork();
    if (child < 0) throw std::runtime_error("no process");
    if (child == 0) {
        ::close(ends[0]);
        limit_memory();
        work(ends[1], load);
        ::_exit(0);
    }
    ::close(ends[1]);
    std::string lines;
    char buffer[4096];
    for (ssize_t n = 0; (n = ::read(ends[0], buffer, sizeof buffer)) > 0;)
        lines.append(buffer, static_cast<std::size_t>(n));
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    return read(lines, status);
}

}  // namespace

Verdict judge(const Document& document, const std::filesystem::path& folder) {
    return judge([&](Document& settings) {
        settings.resolution = document.resolution;
        settings.rays = document.rays;
        settings.fast = document.fast;
        return load(document, folder);
    });
}

Verdict judge_file(const std::filesystem::path& path) {
    return judge([&](Document& settings) {
        std::ifstream in(path, std::ios::binary);
        settings = settings_of({std::istreambuf_iterator<char>(in), {}});
        return x3d::read_file(path);
    });
}

}  // namespace nuvo::fuzz
