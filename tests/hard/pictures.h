#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

#include "nuvo/image/image.h"
#include "nuvo/scene/camera.h"
#include "nuvo/scene/scene.h"

namespace nuvo::hard {

/// How a picture of the program compares with the reference.
struct PictureCheck {
    int pixels = 0;
    int off = 0;           ///< further off than 1/255 in a channel
    int masked = 0;        ///< of those, on the silhouette mask
    int rounded = 0;       ///< of those, where the rounding of the lit point decides by definition
    int fast_differs = 0;  ///< pixels at which the fast tracer differs from the exact profile
    int wrong() const { return off - masked - rounded; }
};

/// The scene through the program with the exact profile.
Image picture(const Scene& scene, Resolution resolution);
/// The pixels at which the fast tracer, on both octrees and with every instruction set of the
/// machine, differs from `exact`, in all.
int fast_differences(const Scene& scene, const Image& exact);
/// Compares `image` with the reference picture; each wrong pixel is printed. `rounded_points`: tell
/// apart where the rounding of the lit point decides.
PictureCheck check_picture(const Scene& scene, const Image& image, std::ostream& faults,
                           bool rounded_points = false);
/// All of testfiles/hard at that size, as a table; true when none is wrong.
bool check_pictures(Resolution resolution, unsigned threads, std::ostream& out);
/// kHardPlaces: plain lamps and a sun where shadows are hard. kRich: every kind of light with all
/// its fields, many materials, blended normals and colors, where shading is hard.
enum class Lighting { kHardPlaces, kRich };
/// Scenes of every class so lit, `count` in all; true when no pixel is wrong. Prints the sums.
bool check_random_pictures(std::uint64_t count, std::uint64_t seed, unsigned threads,
                           std::ostream& out, Lighting lighting = Lighting::kHardPlaces);
/// testfiles/hard/NAME.x3d
std::string hard_scene_path(const std::string& name);

}  // namespace nuvo::hard
