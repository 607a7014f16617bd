#pragma once

#include <string>
#include <utility>
#include <vector>

namespace nuvo::app {

/// What this program was built from and with.
struct BuildInfo {
    std::string version;
    std::string commit;  ///< "-dirty" behind it: with changes; "unknown" outside a repository
    std::string compiler;
    std::string flags;
    std::string build_type;
    std::vector<std::pair<std::string, std::string>> libraries;  ///< name and version
    std::vector<std::string> instruction_sets;  ///< of this machine and program, the best first
};
BuildInfo build_info();

/// What --version prints; the first line is name and version alone.
std::string version_text();

}  // namespace nuvo::app
