#pragma once

#include <iosfwd>
#include <string>

#include "nuvo/image/image.h"
#include "nuvo/scene/camera.h"
#include "nuvo/scene/scene.h"

namespace nuvo::hard {

/// How a picture of the program compares with the reference.
struct PictureCheck {
    int pixels = 0;
    int off = 0;     ///< further off than 1/255 in a channel
    int masked = 0;  ///< of those, on the silhouette mask
    int wrong() const { return off - masked; }
};

/// The scene through the program with the exact profile.
Image picture(const Scene& scene, Resolution resolution);
/// Compares `image` with the reference picture; each wrong pixel is printed.
PictureCheck check_picture(const Scene& scene, const Image& image, std::ostream& faults);
/// All of testfiles/hard at that size, as a table; true when none is wrong.
bool check_pictures(Resolution resolution, unsigned threads, std::ostream& out);
/// testfiles/hard/NAME.x3d
std::string hard_scene_path(const std::string& name);

}  // namespace nuvo::hard
