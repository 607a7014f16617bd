#pragma once

#include <filesystem>

#include "pipelines.h"

namespace nuvo::fuzz {

/// How a document fared.
struct Verdict {
    bool refused = false;  ///< by the loader
    std::string refusal;
    std::vector<Finding> findings;
    int runs = 0;  ///< pipelines that ended
};

/// Loads and checks the document in a process of its own, so that crashes and endless loops are
/// findings, too. `folder` is for files of Inlines. Only one thread may be running.
Verdict judge(const Document& document, const std::filesystem::path& folder);
/// The same for a file that stands there already.
Verdict judge_file(const std::filesystem::path& path);

}  // namespace nuvo::fuzz
