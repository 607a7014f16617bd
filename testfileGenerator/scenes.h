#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace nuvo::generator {

/// The seed of the scenes for measuring, unless another is asked for.
inline constexpr std::uint64_t kDefaultSeed = 2;

/// Where the camera of an octree test stands.
enum class CameraPlace {
    kOwn,   ///< as in testfiles/
    kFar,   ///< where the scene fits the picture's height
    kNear,  ///< at 0.3 of that distance from the scene's front
};

/// What a scene may be asked to do differently. The default gives the files in testfiles/.
struct Variation {
    std::uint64_t seed = kDefaultSeed;
    CameraPlace camera = CameraPlace::kOwn;
    int count = 0;  ///< shapes of a scene that has no number of its own
};

/// The options that a scene takes beside the seed.
struct Takes {
    bool camera = false;
    bool count = false;  ///< needs it, and is no file of testfiles/
};

/// One scene the program can write. The same seed gives the same text on every platform; scenes
/// without chance in them ignore it.
struct Scene {
    std::string_view name;
    std::string_view summary;
    std::string (*write)(const Variation& variation);
    Takes takes = {};
};

/// Every scene: those of testfiles/ in the order of the thesis, then those of any size.
std::span<const Scene> all_scenes();

// The thesis' validation scenes (sections 5.6.1 to 5.6.3, appendices E to G).
std::string appendix_e(const Variation& variation);
std::string appendix_f(const Variation& variation);
std::string appendix_g(const Variation& variation);
std::string figure_25(const Variation& variation);
std::string figure_27(const Variation& variation);
std::string figure_28(const Variation& variation);
std::string figure_29(const Variation& variation);

// Figures that the thesis shows without a listing.
std::string figure_19(const Variation& variation);
std::string figure_20(const Variation& variation);
std::string figure_22(const Variation& variation);
std::string icosphere_scene(const Variation& variation);

// The scenes of the octree tests (section 5.7.3): the base test and tests 1 to 4.
std::string teapot_scene(const Variation& variation);
std::string trianglemesh_scene(const Variation& variation);
std::string both_scene(const Variation& variation);
std::string concentric_scene(const Variation& variation);
std::string clumped_scene(const Variation& variation);

// A picture for the README.
std::string showcase_scene(const Variation& variation);

// Scenes of any size, for measuring.
std::string many_octahedra(const Variation& variation);
std::string many_spheres(const Variation& variation);

// Scenes of any size like those that people render, for measuring.
std::string terrain_scene(const Variation& variation);
std::string city_scene(const Variation& variation);
std::string interior_scene(const Variation& variation);
std::string assembly_scene(const Variation& variation);
std::string floor_scene(const Variation& variation);
std::string molecule_scene(const Variation& variation);

// Families for the study of midpoints; the seed varies what makes each hard.
std::string aisles_scene(const Variation& variation);
std::string drift_scene(const Variation& variation);
std::string stadium_scene(const Variation& variation);
std::string sticks_scene(const Variation& variation);
std::string sizes_scene(const Variation& variation);

}  // namespace nuvo::generator
