// What is packed, marked or written differently reads the same; sizes are limited.
#include <random>

#include "gzip.h"
#include "scene/loading.h"
#include "scene/temporary_folder.h"

namespace nuvo {
namespace {

const std::string kScene = bare(shape("<Sphere radius='2'/>"));

TEST(LoaderGzip, PackedFilesReadAsTheTextInThem) {
    EXPECT_EQ(load(packed(kScene)).objects.size(), 1u);
    const TemporaryFolder folder;
    EXPECT_EQ(x3d::read_file(folder.put("packed.x3d", packed(kScene))).objects.size(), 1u);
    // Two members, one after the other, and zeros as padding.
    EXPECT_EQ(load(packed(kScene.substr(0, 9)) + packed(kScene.substr(9)) + std::string(99, '\0'))
                  .objects.size(),
              1u);
}

TEST(LoaderGzip, DamagedOnesAreRefused) {
    const std::string good = packed(kScene);
    EXPECT_EQ(refusal("\x1f\x8b\x08rest"), "scene.x3d: packed by gzip, but damaged");
    for (std::size_t size = 2; size < good.size(); ++size)
        EXPECT_EQ(refusal(good.substr(0, size)), "scene.x3d: packed by gzip, but cut off") << size;
    std::string flipped = good;
    flipped[good.size() - 6] = static_cast<char>(flipped[good.size() - 6] ^ 1);  // its checksum
    EXPECT_EQ(refusal(flipped), "scene.x3d: packed by gzip, but damaged");
}

TEST(LoaderGzip, BombsAreRefusedWhileTheyUnpack) {
    std::string blanks(1'000'000, ' ');
    std::string bomb;
    const std::string member = packed(blanks);
    for (int i = 0; i < 128; ++i) bomb += member;
    ASSERT_LT(bomb.size(), 200'000u);
    const TemporaryFolder folder;
    const auto message = [&](const std::string& bytes, const x3d::Limits& limits) -> std::string {
        const std::filesystem::path path = folder.put("bomb.x3d", bytes);
        try {
            x3d::read_file(path, {.limits = limits});
        } catch (const x3d::Error& error) {
            return std::string(error.what()).substr(path.string().size());
        }
        return "";
    };
    // 128 million blanks are allowed, but no scene; one more is not.
    EXPECT_EQ(message(bomb, {}), ": empty file: no root element");
    EXPECT_EQ(message(bomb + packed(" "), {}),
              ": unpacks to more bytes than allowed (limit 128000000)");
    x3d::Limits limits;
    limits.file_bytes = kScene.size();
    EXPECT_EQ(message(packed(kScene), limits), "");
    limits.file_bytes = kScene.size() - 1;
    EXPECT_EQ(message(packed(kScene), limits), ": unpacks to more bytes than allowed (limit " +
                                                   std::to_string(kScene.size() - 1) + ")");
}

TEST(LoaderLimits, FilesAreLimitedAtTheLimit) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.put("scene.x3d", kScene);
    x3d::Limits limits;
    for (const std::size_t more : {1, 0}) {
        limits.file_bytes = kScene.size() + more;
        EXPECT_NO_THROW(x3d::read_file(path, {.limits = limits}));
    }
    limits.file_bytes = kScene.size() - 1;
    EXPECT_THROW(x3d::read_file(path, {.limits = limits}), x3d::Error);
}

TEST(LoaderLimits, AttributesAreLimitedAtTheLimit) {
    x3d::Limits limits;
    limits.attributes = 10;
    const auto spheres = [](std::size_t n) {
        return bare(repeated("<Shape><Sphere radius='1'/></Shape>", n));
    };
    EXPECT_EQ(refusal(spheres(9), limits), "");
    EXPECT_EQ(refusal(spheres(10), limits), "");
    EXPECT_EQ(refusal(spheres(11), limits), "scene.x3d: line 1: too many attributes (limit 10)");
    EXPECT_EQ(refusal(spheres(1000), limits), "scene.x3d: line 1: too many attributes (limit 10)");
}

/// Everything of two scenes that a picture depends on.
void expect_same(const Scene& a, const Scene& b) {
    EXPECT_EQ(a.camera, b.camera);
    EXPECT_EQ(a.background, b.background);
    EXPECT_EQ(a.lights, b.lights);
    EXPECT_EQ(a.materials, b.materials);
    ASSERT_EQ(a.objects.size(), b.objects.size());
    for (std::size_t i = 0; i < a.objects.size(); ++i) {
        EXPECT_EQ(a.objects[i].material, b.objects[i].material);
        EXPECT_EQ(a.objects[i].solid, b.objects[i].solid);
        const auto* mesh = std::get_if<TriangleMesh>(&a.objects[i].shape);
        if (mesh == nullptr) continue;
        const auto& other = std::get<TriangleMesh>(b.objects[i].shape);
        EXPECT_EQ(mesh->positions, other.positions);
        EXPECT_EQ(mesh->triangles, other.triangles);
        EXPECT_EQ(mesh->normals, other.normals);
        EXPECT_EQ(mesh->colors, other.colors);
    }
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
        text.replace(at, what.size(), with);
    return text;
}

TEST(LoaderSyntax, VariantsOfAFileReadTheSame) {
    const std::string plain =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<X3D version='3.3'>\n<Scene>\n"
        "<Viewpoint position='0 0 5' fieldOfView='0.5'/>\n<PointLight location='1 2 3'/>\n"
        "<Transform rotation='0 1 0 0.5' translation='1 0 0'>\n<Shape>\n<Appearance>"
        "<Material diffuseColor='1 0.5 0.25' shininess='0.5'/></Appearance>\n"
        "<IndexedFaceSet solid='false' coordIndex='0 1 2 -1 0 2 3 -1'>\n"
        "<Coordinate point='0 0 0 1 0 0 1 1 0 0 1 0'/>\n</IndexedFaceSet></Shape>\n"
        "</Transform>\n</Scene>\n</X3D>\n";
    const Scene expected = load(plain);
    ASSERT_EQ(expected.objects.size(), 1u);
    const std::string doctype =
        "<!DOCTYPE X3D PUBLIC \"ISO//Web3D//DTD X3D 3.3//EN\" "
        "\"http://www.web3d.org/specifications/x3d-3.3.dtd\">\n<X3D";
    for (const std::string& variant :
         {replaced(plain, "\n", "\r\n"), replaced(plain, "\n", "\r"), "\xef\xbb\xbf" + plain,
          packed(plain), replaced(plain, "'", "\""), replaced(plain, "false", "FALSE"),
          replaced(plain, "0 0 0 1 0 0 1 1 0 0 1 0", "0 0 0, 1 0 0,\n1 1 0,\t0,1,0, "),
          replaced(plain, "0 1 2 -1 0 2 3 -1", "0,1,2,-1,0,2,3"),
          replaced(plain, "rotation='0 1 0 0.5' translation='1 0 0'",
                   "translation='+1. 0e5 .0'\n  rotation = '0 1 0 5e-1'\n"),
          replaced(plain, "<Scene>", "<head><meta name='a'/></head><Scene><!-- <Shape/> -->"),
          replaced(plain, "<X3D", doctype),
          replaced(plain, "<Shape>", "<?pi <Shape> ?><Shape DEF='s' class='c' unknown='7'>"),
          replaced(plain, "<Appearance>", "<![CDATA[ <Sphere/> ]]><Appearance>"),
          replaced(plain, "'1 0.5 0.25'", "'&#49; 0.5&#x20;0.25'"),
          replaced(plain, "/></Appearance>", "></Material ></Appearance>")}) {
        ASSERT_NE(variant, plain);
        const Scene scene = load(variant);
        expect_same(scene, expected);
        EXPECT_TRUE(scene.warnings.empty());
    }
}

TEST(LoaderBytes, RandomOnesAreRefusedOrReadButNothingElse) {
    const unsigned seed = 4;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const std::string letters = "<>/='\" \n&;!-[]?X3DSceneShape0129.,";
    for (int round = 0; round < 3000; ++round) {
        std::string text = round % 2 == 0 ? "" : "<Scene><Shape>";
        const std::size_t size = random() % 200;
        for (std::size_t i = 0; i < size; ++i)
            text += round % 3 == 0 ? static_cast<char>(random() % 256)
                                   : letters[random() % letters.size()];
        try {
            load(text);
        } catch (const x3d::Error& error) {
            EXPECT_EQ(std::string(error.what()).rfind("scene.x3d: ", 0), 0u);
        }
    }
    // A valid file with a few bytes changed.
    const std::string good = versioned("3.3", shape("<Sphere radius='2'/>") + "<PointLight/>");
    for (int round = 0; round < 5000; ++round) {
        std::string text = good;
        for (int i = 0; i < 3; ++i)
            text[random() % text.size()] = round % 2 == 0 ? static_cast<char>(random() % 256)
                                                          : letters[random() % letters.size()];
        try {
            load(text);
        } catch (const x3d::Error& error) {
            EXPECT_EQ(std::string(error.what()).rfind("scene.x3d: ", 0), 0u);
        }
    }
}

}  // namespace
}  // namespace nuvo
