#pragma once

#include <cstddef>
#include <string>

namespace nuvo::app {

/// As printf.
__attribute__((format(printf, 1, 2))) std::string format(const char* pattern, ...);

/// "1 voxel", "2 voxels".
std::string counted(std::size_t n, const char* noun);

}  // namespace nuvo::app
