// Shapes exactly where an earlier one is.
#include "scene/loading.h"

namespace nuvo {
namespace {

std::string moved(const std::string& nodes) {
    return "<Transform translation='1 0 0'>" + nodes + "</Transform>";
}

TEST(Repeats, AreCountedAndWarnedOfButNotDrawn) {
    for (const std::string geometry :
         {"<Sphere/>", "<Box/>",
          "<TriangleSet><Coordinate point='0 0 0 1 0 0 0 1 0'/></TriangleSet>"}) {
        const std::string one = shape(geometry);
        const Scene scene = load(bare(one + moved(one) + one + moved(one) + shape("<Cone/>")));
        ASSERT_EQ(scene.objects.size(), 3u) << geometry;
        EXPECT_EQ(scene.shape_count, 5u);
        EXPECT_EQ(scene.objects[1].shape_index, 1u);
        EXPECT_EQ(scene.objects[2].shape_index, 4u);
        ASSERT_EQ(scene.warnings.size(), 1u);
        EXPECT_NE(scene.warnings[0].find(": 2 exactly where an earlier one is"), std::string::npos);
    }
    const std::string egg = "<Transform scale='1 2 3'>" + shape("<Sphere/>") + "</Transform>";
    EXPECT_EQ(load(bare(egg + egg)).objects.size(), 1u);
}

TEST(Repeats, OneBitOfDifferenceMakesAnotherShape) {
    const std::string one = shape("<Sphere radius='1'/>");
    EXPECT_EQ(load(bare(one + shape("<Sphere radius='1.0000000000000002'/>"))).objects.size(), 2u);
    EXPECT_EQ(load(bare(one + "<Transform translation='0 0 5e-324'>" + one + "</Transform>"))
                  .objects.size(),
              2u);
    const std::string points = "<Coordinate point='0 0 0 1 0 0 0 1 0'/></IndexedTriangleSet>";
    EXPECT_EQ(load(bare(shape("<IndexedTriangleSet index='0 1 2'>" + points) +
                        shape("<IndexedTriangleSet index='0 2 1'>" + points)))
                  .objects.size(),
              2u);
}

TEST(Repeats, AMillionInOnePlaceAreOne) {
    std::string nodes = "<Group DEF='g0'>" + shape("<Sphere/>") + "</Group>";
    for (int i = 1; i <= 19; ++i) {
        const std::string use = "<Group USE='g" + std::to_string(i - 1) + "'/>";
        nodes += "<Group DEF='g" + std::to_string(i) + "'>" + use + use + "</Group>";
    }
    const Scene scene = load(bare(nodes));
    EXPECT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(scene.shape_count, (1u << 20) - 1);
}

}  // namespace
}  // namespace nuvo
