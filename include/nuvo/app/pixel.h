#pragma once

#include <string>

#include "nuvo/app/options.h"
#include "nuvo/render/explain.h"

namespace nuvo::app {

/// What --pixel tells of a scene by one walk.
struct PixelReport {
    std::string file;
    int x = 0;
    int y = 0;
    Profile profile;  ///< of the walk
    PixelStory story;
};

/// The life of the pixel's ray for people, some lines.
std::string pixel_text(const Options& options, const Scene& scene, const Primitives& primitives,
                       const PixelReport& report);
/// For programs: JSON.
std::string pixel_json(const Options& options, const Scene& scene, const Primitives& primitives,
                       const PixelReport& report);

}  // namespace nuvo::app
