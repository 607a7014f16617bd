#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace nuvo::generator {

/// One scene the program can write. The same seed gives the same text on every platform; scenes
/// without chance in them ignore it.
struct Scene {
    std::string_view name;
    std::string_view summary;
    std::string (*write)(std::uint64_t seed);
};

/// The seed of the files in testfiles/ (README.md says why it is this one).
inline constexpr std::uint64_t kDefaultSeed = 2;

/// Every scene, in the order of the thesis.
std::span<const Scene> all_scenes();

// The thesis' validation scenes (sections 5.6.1 to 5.6.3, appendices E to G).
std::string appendix_e(std::uint64_t seed);
std::string appendix_f(std::uint64_t seed);
std::string appendix_g(std::uint64_t seed);
std::string figure_25(std::uint64_t seed);
std::string figure_27(std::uint64_t seed);
std::string figure_28(std::uint64_t seed);
std::string figure_29(std::uint64_t seed);

// Scenes of triangle meshes (section 5.6.4, and the program's default file).
std::string icosphere_scene(std::uint64_t seed);
std::string trianglemesh_scene(std::uint64_t seed);

// The scenes of the octree tests (section 5.7.3).
std::string teapot_scene(std::uint64_t seed);
std::string test_1(std::uint64_t seed);
std::string test_2(std::uint64_t seed);
std::string test_3(std::uint64_t seed);
std::string test_4(std::uint64_t seed);

}  // namespace nuvo::generator
