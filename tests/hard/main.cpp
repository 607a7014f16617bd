#include <cstdlib>
#include <iostream>
#include <string>

#include "classes.h"
#include "leaks.h"
#include "run.h"

namespace {

constexpr const char* kUsage =
    "usage: hard_cases [flag]...\n"
    "  --rays=N       rays against exact arithmetic, over all classes (1000000)\n"
    "  --seed=S       any number (1)\n"
    "  --class=NAME   one class only\n"
    "  --leaks=N      instead: rays from inside closed meshes at their corners and edges\n"
    "  --threads=N    batches at once (as many as the machine has)\n"
    "  --list         the classes\n";

struct Flags {
    nuvo::hard::RunOptions run;
    std::uint64_t leaks = 0;
    bool list = false;
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
    if (name == "--help" || name == "-h") return flags.help = true;
    if (name == "--class") {
        flags.run.only = value;
        return true;
    }
    if (!read_number(value, number)) return false;
    if (name == "--rays")
        flags.run.rays = number;
    else if (name == "--seed")
        flags.run.seed = number;
    else if (name == "--leaks")
        flags.leaks = number;
    else if (name == "--threads")
        flags.run.threads = static_cast<unsigned>(number);
    else
        return false;
    return true;
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
    if (flags.leaks > 0) {
        const LeakCount count =
            count_leaks(flags.leaks, flags.run.seed, flags.run.threads, std::cerr);
        std::cout << count.leaks << " leaks of " << count.rays << " rays, seed " << flags.run.seed
                  << "\n";
        return count.leaks == 0 ? 0 : 1;
    }
    const std::vector<ClassTally> tallies = run(flags.run, std::cerr);
    if (tallies.empty()) {
        std::cerr << "hard_cases: no class " << flags.run.only << " (--list names them)\n";
        return 2;
    }
    const bool right = print(std::cout, tallies);
    std::cout << (right ? "all right" : "WRONG") << ", seed " << flags.run.seed << "\n";
    return right ? 0 : 1;
}
