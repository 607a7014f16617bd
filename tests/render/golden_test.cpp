// The exporters' files in testfiles/x3d against pictures that were looked at once and kept. With
// NUVO_UPDATE_GOLDEN=1 in the environment the pictures are written instead of compared.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "nuvo/image/bmp.h"
#include "nuvo/image/compare.h"
#include "nuvo/render/render.h"
#include "nuvo/scene/x3d.h"

namespace nuvo {
namespace {

constexpr Resolution kSize{96, 54};
const std::filesystem::path kRoot = NUVO_SOURCE_DIR;

std::string header() {
    return "P6\n" + std::to_string(kSize.width) + " " + std::to_string(kSize.height) + "\n255\n";
}

void write_ppm(const std::filesystem::path& path, const Image& image) {
    std::ofstream file(path, std::ios::binary);
    file << header();
    for (const Rgb8& p : image.pixels())
        file << static_cast<char>(p.r) << static_cast<char>(p.g) << static_cast<char>(p.b);
}

Image read_ppm(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    Image image(kSize.width, kSize.height);
    const std::size_t begin = header().size();
    if (bytes.substr(0, begin) != header() || bytes.size() != begin + 3 * image.pixels().size())
        throw std::runtime_error(path.string() + " is no picture of the size that is compared");
    std::size_t next = begin;
    const auto channel = [&] { return static_cast<std::uint8_t>(bytes[next++]); };
    for (int y = 0; y < kSize.height; ++y)
        for (int x = 0; x < kSize.width; ++x) {
            Rgb8& pixel = image.at(x, y);
            pixel.r = channel();
            pixel.g = channel();
            pixel.b = channel();
        }
    return image;
}

Image rendered(const std::filesystem::path& file) {
    const Scene scene = x3d::read_file(file);
    Profile profile = exact_profile();
    profile.type = OctreeType::kUniform;
    const Primitives primitives = flatten(scene, profile.leaves);
    return render(scene, primitives, build_tree(scene, primitives, profile), profile, kSize);
}

class Golden : public testing::TestWithParam<const char*> {};

TEST_P(Golden, PictureIsTheOneKept) {
    const std::string name = GetParam();
    const Image image = rendered(kRoot / "testfiles/x3d" / (name + ".x3d"));
    const std::filesystem::path golden = kRoot / "tests/golden" / (name + ".ppm");
    if (std::getenv("NUVO_UPDATE_GOLDEN") != nullptr) return write_ppm(golden, image);
    const Image expected = read_ppm(golden);
    const image::Difference difference = image::compare(image, expected);
    if (difference.equal()) return;
    const std::filesystem::path out =
        std::filesystem::path(testing::TempDir()) / ("nuvo-golden-" + name + "-difference.bmp");
    image::write_bmp(out, image::difference_picture(image, expected));
    ADD_FAILURE() << difference.differing_pixels << " pixels differ, most at " << difference.x
                  << "," << difference.y << " by " << difference.max_difference << ": see " << out;
}

INSTANTIATE_TEST_SUITE_P(Exports, Golden,
                         testing::Values("blender_default_scene", "blender_icosphere_smooth",
                                         "blender_scene_full", "blender_suzanne_flat",
                                         "gmsh_box_sphere", "meshlab_torus"),
                         [](const auto& parameter) { return std::string(parameter.param); });

}  // namespace
}  // namespace nuvo
