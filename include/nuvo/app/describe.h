#pragma once

#include <string>

#include "nuvo/scene/scene.h"

namespace nuvo::app {

/// What a scene holds, some lines for people: its shapes, triangles, lights, camera, background,
/// bounds and how many warnings reading it gave.
std::string description(const std::string& file, const Scene& scene, double parse_seconds);

}  // namespace nuvo::app
