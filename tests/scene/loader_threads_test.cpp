// Numbers of large meshes are read on several threads: the scene and what is said of it are the
// same.
#include "scene/loading.h"

namespace nuvo {
namespace {

constexpr int kSide = 140;  // points a side: each list takes several times what one thread reads

struct Lists {
    std::vector<std::string> point;
    std::vector<std::string> index;

    std::string file() const {
        const auto joined = [](const std::vector<std::string>& words) {
            std::string text;
            for (std::size_t i = 0; i < words.size(); ++i)
                text += words[i] + (i % 7 == 0 ? ",\n" : i % 5 == 0 ? "\t " : " ");
            return text;
        };
        return bare(shape("<IndexedTriangleSet normalPerVertex='false' index='" + joined(index) +
                          "'><Coordinate point='" + joined(point) + "'/></IndexedTriangleSet>"));
    }
};

/// A grid over (x, y) at heights that tell each point from all others.
Lists grid() {
    Lists lists;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            for (const std::string& word : {std::to_string(x) + ".25", std::to_string(y) + ".5e0",
                                            "-" + std::to_string(x + kSide * y) + ".0625"})
                lists.point.push_back(word);
    for (int y = 0; y + 1 < kSide; ++y)
        for (int x = 0; x + 1 < kSide; ++x)
            for (const int corner : {x + kSide * y, x + 1 + kSide * y, x + 1 + kSide * (y + 1)})
                lists.index.push_back(std::to_string(corner));
    return lists;
}

/// What one thread and several make of a file.
struct Reading {
    Scene scene;
    std::string refusal;
};
Reading reading(const std::string& text, int threads, bool strict) {
    x3d::ReadOptions options;
    options.threads = threads;
    options.strict = strict;
    try {
        return {x3d::read_text(text, "scene.x3d", options), ""};
    } catch (const x3d::Error& error) {
        return {{}, error.what()};
    }
}

TEST(LoaderThreads, LongListsAreReadWhole) {
    const std::string text = grid().file();
    for (const int threads : {1, 2, 7}) {
        const Scene scene = reading(text, threads, true).scene;
        ASSERT_EQ(scene.objects.size(), 1u);
        const auto& mesh = std::get<TriangleMesh>(scene.objects[0].shape);
        // The last row's first point is no triangle's corner.
        ASSERT_EQ(mesh.positions.size(), static_cast<std::size_t>(kSide) * kSide - 1);
        for (int i = 0; i < kSide * (kSide - 1); ++i)
            ASSERT_EQ(mesh.positions[static_cast<std::size_t>(i)],
                      (Point3{i % kSide + 0.25, i / kSide + 0.5, -i - 0.0625}));
        ASSERT_EQ(mesh.triangles.size(), static_cast<std::size_t>(kSide - 1) * (kSide - 1));
        EXPECT_EQ(mesh.triangles[kSide], (IndexTriple{kSide + 1, kSide + 2, 2 * kSide + 2}));
    }
}

TEST(LoaderThreads, WhatIsNoPlainNumberIsToldAsByOne) {
    const Lists plain = grid();
    for (const char* word :
         {"+3", "x", "1e400", "1e-400", "nan", "0x1", "99999999999", "-1", "1.5"})
        for (const double place : {0.0, 0.7}) {
            for (const bool in_points : {false, true}) {
                Lists changed = plain;
                std::vector<std::string>& list = in_points ? changed.point : changed.index;
                list[static_cast<std::size_t>(place * static_cast<double>(list.size()))] = word;
                const std::string text = changed.file();
                for (const bool strict : {false, true}) {
                    const Reading one = reading(text, 1, strict);
                    const Reading many = reading(text, 3, strict);
                    EXPECT_EQ(one.refusal, many.refusal);
                    EXPECT_EQ(one.scene.warnings, many.scene.warnings);
                    ASSERT_EQ(one.scene.objects.size(), many.scene.objects.size()) << word;
                    if (one.scene.objects.empty()) continue;
                    const auto& expected = std::get<TriangleMesh>(one.scene.objects[0].shape);
                    const auto& mesh = std::get<TriangleMesh>(many.scene.objects[0].shape);
                    EXPECT_EQ(mesh.positions, expected.positions);
                    EXPECT_EQ(mesh.triangles, expected.triangles);
                }
            }
        }
}

}  // namespace
}  // namespace nuvo
