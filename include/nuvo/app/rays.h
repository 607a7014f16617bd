#pragma once

#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "nuvo/math/ray.h"
#include "nuvo/render/render.h"

namespace nuvo::app {

/// A file of rays that cannot be read: what() is one line, "FILE: line N: reason".
class RaysError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A ray a line, "ox oy oz dx dy dz" in decimal, separated by blanks; blank lines are skipped. The
/// direction is used as given, any length but zero. Throws RaysError; `name` stands for the file.
std::vector<Ray> parse_rays(std::string_view text, const std::string& name);
std::vector<Ray> read_rays(const std::filesystem::path& path);

/// A line a ray: "1 shape triangle t" with t to 17 digits, "0 -1 -1 inf" for a miss.
std::string answers_text(std::span<const RayAnswer> answers);

}  // namespace nuvo::app
