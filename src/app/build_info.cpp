#include "nuvo/app/build_info.h"

#include <algorithm>
#include <string_view>

#include "nuvo/app/choices.h"
#include "nuvo_commit.h"

namespace nuvo::app {
namespace {

std::string compiler() {
#if defined(__clang__)
    return "clang " __clang_version__;
#else
    return "g++ " __VERSION__;
#endif
}

}  // namespace

BuildInfo build_info() {
    BuildInfo info;
    info.version = NUVO_VERSION;
    info.commit = NUVO_COMMIT;
    info.compiler = compiler();
    info.flags = NUVO_BUILD_FLAGS;
    info.build_type = NUVO_BUILD_TYPE;
    const std::string_view libraries = NUVO_LIBRARIES;  // "Boost 1.74.0|NLopt 2.7.1"
    for (std::size_t at = 0; at < libraries.size();) {
        const std::size_t end = std::min(libraries.find('|', at), libraries.size());
        const std::string_view entry = libraries.substr(at, end - at);
        const std::size_t blank = std::min(entry.find(' '), entry.size());
        info.libraries.emplace_back(entry.substr(0, blank),
                                    entry.substr(std::min(blank + 1, entry.size())));
        at = end + 1;
    }
    for (const InstructionSet isa : supported_instruction_sets())
        info.instruction_sets.emplace_back(name_of(kInstructionSets, isa));
    return info;
}

std::string version_text() {
    const BuildInfo info = build_info();
    std::string text = "nuvo " + info.version + "\n";
    text += "commit     " + info.commit + "\n";
    text += "compiler   " + info.compiler + ", " + info.build_type + ": " + info.flags + "\n";
    std::string list;
    for (const std::string& name : info.instruction_sets) list += (list.empty() ? "" : ", ") + name;
    text += "kernels    " + list + " (of this machine, best first)\n";
    list.clear();
    for (const auto& [name, version] : info.libraries)
        list += (list.empty() ? "" : ", ") + name + " " + version;
    return text + "libraries  " + list + "\n";
}

}  // namespace nuvo::app
