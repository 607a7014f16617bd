#pragma once

#include <filesystem>
#include <vector>

#include "nuvo/app/options.h"
#include "nuvo/app/report.h"

namespace nuvo::app {

/// The files that heat map, planes and octree of a pass go to, as far as the options want them.
/// `pass` is its name where there are several, which then stands in the files' names; else empty.
std::vector<std::filesystem::path> look_files(const Options& options,
                                              const std::filesystem::path& picture,
                                              const std::string& pass);

/// Writes them from what the passes have recorded, all heat maps on one scale, and notes them in
/// the passes. `scene` names the scene. Throws image::WriteError.
void write_looks(const Options& options, const std::filesystem::path& picture,
                 const std::string& scene, std::vector<Pass>& passes);

}  // namespace nuvo::app
