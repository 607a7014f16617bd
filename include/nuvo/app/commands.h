#pragma once

#include <filesystem>
#include <string>

#include "nuvo/app/options.h"

namespace nuvo::app {

/// What the program ends with.
enum ExitCode : int {
    kDone = 0,
    kPicturesDiffer = 1,
    kUsage = 2,
    kSceneRefused = 3,
    kCannotWrite = 4,  ///< or out of memory
    kSignalBase = 128  ///< plus the signal's number
};

/// Builds and traces `repetitions` times and writes the picture.
ExitCode render_command(const Options& options);
/// Renders with every octree type and by brute force and writes the uniform picture and the
/// difference picture of the pair that is furthest apart (black where none differs).
ExitCode compare_command(const Options& options);
/// Renders with every combination of answers worth comparing and tells speed and error of each.
ExitCode study_command(const Options& options);
/// Answers the rays of a file.
ExitCode rays_command(const Options& options);
/// Tells the life of one pixel's ray.
ExitCode pixel_command(const Options& options);
/// Says what was read and draws nothing.
ExitCode describe_command(const Options& options);
// All throw UsageError, x3d::Error, RaysError, image::WriteError and std::bad_alloc.

/// The file that `--file` names: as given if there is a file of that name, else with .x3d or .x3dz
/// appended. Throws x3d::Error where there is none.
std::filesystem::path find_scene(const std::string& name);

/// Where the picture of a scene goes when nobody says: beside it, with .bmp in place of
/// .x3d, .x3dz or .xml.
std::filesystem::path picture_beside(const std::filesystem::path& scene);

/// Where the difference picture goes: "NAME-difference" beside the picture, with its ending; a
/// picture that is no regular file (a device) takes it, too.
std::filesystem::path difference_beside(const std::filesystem::path& picture);

}  // namespace nuvo::app
