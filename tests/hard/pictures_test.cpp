#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>

#include "nuvo/render/render.h"
#include "nuvo/scene/x3d.h"
#include "pictures.h"
#include "reference.h"
#include "scene_files.h"

namespace nuvo::hard {
namespace {

constexpr Resolution kSize{80, 45};

Scene hard_scene(const std::string& name) { return x3d::read_file(hard_scene_path(name)); }

TEST(HardPictures, EqualTheReferenceOutsideTheSilhouetteMask) {
    std::ostringstream report;
    EXPECT_TRUE(check_pictures(kSize, 0, report)) << report.str();
}

TEST(HardPictures, ScenesOfEveryClassLitFromSurfacesEqualTheReference) {
    std::ostringstream report;
    EXPECT_TRUE(check_random_pictures(104, 13, 0, report)) << report.str();
}

TEST(HardPictures, RichlyLitScenesOfEveryClassEqualTheReference) {
    std::ostringstream report;
    EXPECT_TRUE(check_random_pictures(200, 14, 0, report, Lighting::kRich)) << report.str();
}

TEST(HardPictures, TheReferenceSeesTheErrorsOfTheThesisProfile) {
    const Scene scene = hard_scene("contact-gaps");
    const Profile profile = thesis_profile();
    const Primitives primitives = flatten(scene, profile.leaves);
    const Image image =
        render(scene, primitives, build_tree(scene, primitives, profile), profile, kSize);
    std::ostringstream faults;
    EXPECT_GT(check_picture(scene, image, faults).wrong(), 0);
}

TEST(HardPictures, TheFilesAreTheGenerators) {
    for (const SceneFile& file : hard_scene_files()) {
        std::ifstream in(hard_scene_path(file.name), std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        EXPECT_EQ(text, file.text) << file.name << ": scripts/hard.sh --write-scenes";
    }
}

// Up to the rounding of the scene's own numbers, which moves silhouettes by less than the mask.
TEST(HardPictures, ScaleAndPlaceChangeNothing) {
    const Scene one = hard_scene("scale-1");
    const Image expected = picture(one, kSize);
    const Reference reference(one, kSize);
    for (const char* name :
         {"scale-1e-15", "scale-1e-6", "scale-1e6", "scale-1e15", "moved-by-1e6"}) {
        const Image image = picture(hard_scene(name), kSize);
        for (int y = 0; y < kSize.height; ++y)
            for (int x = 0; x < kSize.width; ++x) {
                const Rgb8 a = expected.at(x, y);
                const Rgb8 b = image.at(x, y);
                const bool near = std::abs(a.r - b.r) <= 1 && std::abs(a.g - b.g) <= 1 &&
                                  std::abs(a.b - b.b) <= 1;
                EXPECT_TRUE(near || !reference.stable(x, y)) << name << " " << x << "," << y;
            }
    }
}

}  // namespace
}  // namespace nuvo::hard
