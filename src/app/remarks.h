#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "nuvo/app/options.h"
#include "nuvo/image/image.h"
#include "nuvo/render/render.h"
#include "nuvo/scene/scene.h"

namespace nuvo::app {

/// Answers rays as the tracer does that made the picture.
using Answers = std::function<std::vector<RayAnswer>(std::span<const Ray>)>;

/// What the user should hear about a picture, a line each: that no ray met anything, that no light
/// adds anything to what is seen, that the camera stands inside a solid. The picture itself rules
/// the first two out at once in most cases; where it does not, some of its rays are asked. Names
/// flags that help, but none that the options have already.
std::vector<std::string> remarks(const Scene& scene, const Options& options, const Profile& profile,
                                 const Image& picture, const Answers& answers);

}  // namespace nuvo::app
