#pragma once

#include <filesystem>
#include <vector>

#include "nuvo/app/options.h"
#include "nuvo/app/report.h"

namespace nuvo::app {

/// The files that heat map, planes and octree go to, as far as the options want them.
std::vector<std::filesystem::path> look_files(const Options& options,
                                              const std::filesystem::path& picture);

/// Writes them from what the pass has recorded, and says so in the report. Throws
/// image::WriteError.
void write_looks(const Options& options, const std::filesystem::path& picture, const Pass& pass,
                 Report& report);

}  // namespace nuvo::app
