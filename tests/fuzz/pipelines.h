#pragma once

#include <functional>
#include <string>
#include <vector>

#include "document.h"
#include "nuvo/scene/scene.h"

namespace nuvo::fuzz {

/// Something that is wrong.
struct Finding {
    std::string key;   ///< its kind and where it was seen first: equal keys, likely one cause
    std::string text;  ///< one line
};

/// What the pipelines tell while they run, so that the last word of one that never ends is known.
struct Listener {
    /// A stage begins; it must not take longer than that, in seconds of processor time.
    std::function<void(const std::string& name, double seconds)> stage;
    std::function<void(const Finding&)> found;
    std::function<void()> ran;  ///< one picture, or one set of rays, was made
};

/// Most processor time that a picture of 160 x 90 may take, octree included.
double seconds_allowed();

/// The scene by every pipeline: brute force, the serial tracer with both octrees, all midpoints and
/// both walks, the fast tracer with every instruction set, 1 and 3 threads and both octrees. All
/// must give the same bytes and answers, in time.
void check(const Scene& scene, const Document& document, const Listener& listener);

}  // namespace nuvo::fuzz
