#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "meter.h"
#include "nuvo/app/memory.h"
#include "nuvo/app/options.h"
#include "nuvo/scene/scene.h"

namespace nuvo::app {

struct LoadedScene {
    std::filesystem::path path;  ///< "-": standard input
    std::string name;            ///< for messages
    Scene scene;
    std::vector<std::string> shape_names;  ///< if answers want them
    double parse_seconds = 0;
    double parse_wall_seconds = 0;
    RunMemory memory;
};

/// Reads the scene that the options name; its warnings go to standard error. Throws x3d::Error.
LoadedScene load(const Options& options, Meter& meter);

/// Finds out now what would stop an output after a long render, or destroy an input. Throws
/// UsageError and image::WriteError.
void check_outputs(const std::vector<std::filesystem::path>& inputs,
                   const std::vector<std::filesystem::path>& outputs);

/// All of standard input. Throws x3d::Error where it is longer than `most` bytes.
std::string read_standard_input(std::size_t most, Progress* progress = nullptr);

bool is_regular(const std::filesystem::path& path);

}  // namespace nuvo::app
