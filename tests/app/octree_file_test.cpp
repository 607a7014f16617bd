#include "octree_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "nuvo/render/render.h"
#include "nuvo/scene/x3d.h"

namespace nuvo::app {
namespace {

std::string text_of(const char* name, const Octree& octree, const std::string& title = "scene") {
    std::string text;
    octree_format(name)->write(octree, title, [&](std::string_view bytes) { text += bytes; });
    return text;
}

Octree octree_of(const char* scene, OctreeType type = OctreeType::kNonuniform) {
    const Scene read = x3d::read_file(std::string(NUVO_SOURCE_DIR) + "/testfiles/" + scene);
    Profile profile = exact_profile();
    profile.type = type;
    return build_tree(read, flatten(read, profile.leaves), profile);
}

Octree one_voxel() {
    Node root;
    root.voxel = Voxel::centered({{0, 0, 0}, {1, 2, 4}});
    root.item_count = 1;
    return {{root}, {0}};
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++found;
    return found;
}

TEST(OctreeFile, EndingsAreTakenInAnyLetterCaseAndOthersAreNot) {
    for (const char* name : {"a.x3d", "b.X3D", "a.json", "c/a.bin"})
        EXPECT_NE(octree_format(name), nullptr) << name;
    for (const char* name : {"a.x3db", "x3d", "a.obj", "a", "a.x3d/"})
        EXPECT_EQ(octree_format(name), nullptr) << name;
}

// The numbers of an attribute that follows `mark`.
std::vector<double> numbers_after(const std::string& text, const std::string& mark) {
    const std::size_t from = text.find(mark) + mark.size();
    std::istringstream in(text.substr(from, text.find('"', from) - from));
    return {std::istream_iterator<double>(in), {}};
}

TEST(OctreeFile, OneVoxelIsALineAlongAllTwelveEdgesOfItsBox) {
    const std::string text = text_of("a.x3d", one_voxel());
    const std::vector<double> points = numbers_after(text, "Coordinate point=\"");
    ASSERT_EQ(points.size(), 24u);
    const std::vector<double> line = numbers_after(text, "coordIndex=\"");
    ASSERT_EQ(line.back(), -1);
    std::map<std::set<double>, int> edges;
    for (std::size_t i = 0; i + 2 < line.size(); ++i) {
        EXPECT_NE(line[i], line[i + 1]);
        ++edges[{line[i], line[i + 1]}];
        int different = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto coordinate = [&](double corner) {
                return points[3 * static_cast<std::size_t>(corner) + axis];
            };
            different += coordinate(line[i]) != coordinate(line[i + 1]) ? 1 : 0;
        }
        EXPECT_EQ(different, 1);
    }
    EXPECT_EQ(edges.size(), 12u);
}

TEST(OctreeFile, X3dHoldsALineForEachVoxelAndAShapeForEachDepth) {
    const Octree octree = octree_of("showcase.x3d");
    const std::string text = text_of("a.x3d", octree);
    ASSERT_GT(octree.leaf_count(), 100u);
    EXPECT_EQ(count(text, " -1\n"), octree.leaf_count());
    std::set<std::string> expected;
    for (const Node& node : octree.nodes())
        if (node.is_leaf())
            expected.insert("DEF=\"depth-" + std::to_string(label_digits(node.label)) +
                            (node.item_count == 0 ? "-empty\"" : "\""));
    EXPECT_EQ(count(text, "<Shape DEF"), expected.size());
    for (const std::string& name : expected) EXPECT_EQ(count(text, name), 1u) << name;
    // Well-formed, and nothing in it that nuvo refuses.
    const Scene again = x3d::read_text(text, "octree.x3d");
    EXPECT_EQ(again.shape_count, expected.size());
    EXPECT_TRUE(again.camera_given);
}

TEST(OctreeFile, ColorsRunFromTheLeastDepthToTheGreatest) {
    const Octree octree = octree_of("both.x3d", OctreeType::kUniform);
    const std::string text = text_of("a.x3d", octree);
    const std::size_t first = text.find("emissiveColor=\"0.267 0.004 0.329\"");  // viridis(0)
    const std::size_t last = text.find("emissiveColor=\"0.992 0.906 0.145\"");   // viridis(1)
    ASSERT_NE(first, std::string::npos);
    ASSERT_NE(last, std::string::npos);
    EXPECT_EQ(text.rfind("<Shape DEF=", first), text.find("<Shape DEF="));
    EXPECT_NE(text.rfind("DEF=\"depth-" + std::to_string(octree.depth() - 1), last),
              std::string::npos);
}

TEST(OctreeFile, ATitleCannotBreakTheFile) {
    const std::string title = "a<b>\"&\n\xff.x3d";
    EXPECT_EQ(x3d::read_text(text_of("a.x3d", one_voxel(), title), "o").shape_count, 1u);
    EXPECT_TRUE(nlohmann::json::accept(text_of("a.json", one_voxel(), title)));
}

TEST(OctreeFile, JsonAndBinaryHoldEachVoxel) {
    const Octree octree = octree_of("both.x3d");
    const nlohmann::json json = nlohmann::json::parse(text_of("a.json", octree));
    const std::string bytes = text_of("a.bin", octree);
    EXPECT_EQ(json["voxels"], octree.leaf_count());
    EXPECT_EQ(json["references"], octree.reference_count());
    ASSERT_EQ(json["leaves"].size(), octree.leaf_count());
    ASSERT_EQ(bytes.size(), 16 + 32 * octree.leaf_count());
    EXPECT_EQ(bytes.substr(0, 8), "nuvooct1");
    const auto word = [&](std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i)
            value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i]))
                     << (8 * i);
        return value;
    };
    EXPECT_EQ(word(8), octree.leaf_count());
    EXPECT_EQ(word(12), 8u);
    std::size_t leaf = 0;
    for (const Node& node : octree.nodes()) {
        if (!node.is_leaf()) continue;
        const nlohmann::json& told = json["leaves"][leaf];
        const Bounds3& box = node.voxel.bounds;
        EXPECT_EQ(told["name"], std::to_string(node.label));
        EXPECT_EQ(told["items"], node.item_count);
        EXPECT_EQ(told["depth"], label_digits(node.label));
        const double numbers[8] = {box.min.x,
                                   box.min.y,
                                   box.min.z,
                                   box.max.x,
                                   box.max.y,
                                   box.max.z,
                                   static_cast<double>(label_digits(node.label)),
                                   static_cast<double>(node.item_count)};
        for (std::size_t i = 0; i < 8; ++i) {
            EXPECT_EQ(std::bit_cast<float>(word(16 + 32 * leaf + 4 * i)),
                      static_cast<float>(numbers[i]));
            if (i < 6) {
                EXPECT_EQ(told[i < 3 ? "min" : "max"][i % 3], numbers[i]);
            }
        }
        ++leaf;
    }
}

TEST(OctreeFile, ASceneWithoutShapesHasAFileToo) {
    const Scene scene = x3d::read_text("<X3D><Scene/></X3D>", "empty");
    const Profile profile = exact_profile();
    const Octree octree = build_tree(scene, flatten(scene, profile.leaves), profile);
    EXPECT_EQ(x3d::read_text(text_of("a.x3d", octree), "o").objects.size(), 0u);
    EXPECT_TRUE(nlohmann::json::accept(text_of("a.json", octree)));
    EXPECT_EQ(text_of("a.bin", octree).size(), 16 + 32 * octree.leaf_count());
}

}  // namespace
}  // namespace nuvo::app
