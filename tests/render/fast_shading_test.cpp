#include "fast/shading/shading.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <random>
#include <sstream>
#include <string>

#include "fast/primary/primary.h"
#include "fast/simd/dispatch.h"
#include "nuvo/render/fast.h"
#include "nuvo/render/render.h"
#include "nuvo/scene/x3d.h"

// The serial tracer's exact profile says what every byte has to be. Stages are driven by the facts
// of its picture, so that shading alone is under test.

namespace nuvo {
namespace {

constexpr Resolution kSize{150, 91};  // the last tiles of rows and columns are cut

struct Shaded {
    int wrong = 0;   // pixels that differ from the exact profile's
    int redone = 0;  // pixels that the fallback decided
};

class ShadedPicture {
  public:
    explicit ShadedPicture(const Scene& scene, Resolution size = kSize)
        : scene_(scene),
          size_(size),
          primitives_(flatten(scene, LeafContent::kPrimitives)),
          fast_(scene, primitives_, OctreeType::kUniform, 1),
          camera_(scene.camera, size, fast_.frame()),
          fallback_(fast_, camera_) {
        const Octree tree = build_tree(scene, primitives_, exact_profile());
        expected_ = render(scene, primitives_, tree, exact_profile(), size);
        facts_ = render_facts(scene, primitives_, tree, exact_profile(), size);
    }

    Shaded shade(InstructionSet isa, bool redo_exactly = true) {
        CameraTables tables(fast_, camera_, isa);
        PrimaryJob job{fast_, camera_, tables, fallback_, true, {}};
        const PrimaryStage primary(isa);
        ShadingTables shading(fast_, camera_, tables, resolved(isa));
        shading.fill_all(1);
        ShadingStage stage(shading, redo_exactly);
        Image image(size_.width, size_.height);
        const auto macro = std::make_unique<MacroTile>();
        const auto quadrics = std::make_unique<EllipsoidNormals>();
        const auto tile = std::make_unique<Tile>();
        Shaded result;
        for (macro->y = 0; macro->y < size_.height; macro->y += kMacroSide)
            for (macro->x = 0; macro->x < size_.width; macro->x += kMacroSide) {
                primary.trace(job, *macro, quadrics.get());
                for (int i = 0; i < MacroTile::kTiles; ++i) {
                    macro->show(i, quadrics.get(), *tile);
                    if (tile->x >= size_.width || tile->y >= size_.height) continue;
                    stage.surface(*tile);
                    for (std::size_t light = 0; light < scene_.lights.size(); ++light)
                        shine(stage, *tile, light);
                    result.redone += stage.finish(*tile, fallback_, image);
                }
            }
        stage.decide_open(fallback_, image);
        for (int y = 0; y < size_.height; ++y)
            for (int x = 0; x < size_.width; ++x)
                if (!(image.at(x, y) == expected_.at(x, y))) ++result.wrong;
        return result;
    }

    int pixels() const { return size_.width * size_.height; }

  private:
    void shine(ShadingStage& stage, const Tile& tile, std::size_t light) const {
        TileMask wanted;
        TileMask lit{};
        stage.sample(tile, light, wanted);
        for (int lane = 0; lane < kTileLanes; ++lane) {
            const int x = tile.x + lane_x(lane);
            const int y = tile.y + lane_y(lane);
            if (x >= size_.width || y >= size_.height) continue;
            const PixelFacts& facts = facts_[static_cast<std::size_t>(y * size_.width + x)];
            const unsigned bit = 1U << lane % kBlockLanes;
            const int block = lane / kBlockLanes;
            if ((wanted[block] & bit) != 0 && (facts.lit >> light & 1) != 0)
                lit[block] = static_cast<std::uint16_t>(lit[block] | bit);
        }
        stage.add(light, lit);
    }

    const Scene& scene_;
    Resolution size_;
    Primitives primitives_;
    FastScene fast_;
    CameraRays camera_;
    ExactFallback fallback_;
    Image expected_;
    std::vector<PixelFacts> facts_;
};

void expect_exact(const Scene& scene, const std::string& name) {
    ShadedPicture picture(scene);
    for (const InstructionSet isa : supported_instruction_sets()) {
        const Shaded shaded = picture.shade(isa);
        EXPECT_EQ(shaded.wrong, 0) << name << ", instruction set " << static_cast<int>(isa);
    }
}

Scene scene_of(const std::string& nodes) {
    return x3d::read_text(
        "<X3D version='3.3'><Scene><NavigationInfo headlight='false'/>" + nodes + "</Scene></X3D>",
        "scene.x3d");
}

std::string shape(const std::string& material, const std::string& geometry) {
    return "<Shape><Appearance><Material " + material + "/></Appearance>" + geometry + "</Shape>";
}

// A floor, a smooth roof, a sphere and a box in front of the default camera.
std::string furniture(const std::string& material) {
    return shape(material,
                 "<IndexedFaceSet coordIndex='0 1 2 3 -1'><Coordinate point='-9 -2 9 9 -2 9 9 -2 "
                 "-9 -9 -2 -9'/></IndexedFaceSet>") +
           shape(material,
                 "<IndexedFaceSet solid='false' creaseAngle='3' coordIndex='0 1 2 -1 0 2 3 -1'>"
                 "<Coordinate point='-3 1 0 -1 1.5 1 0 3 -1 -3 2.5 -2'/></IndexedFaceSet>") +
           "<Transform translation='1.5 0 0'>" + shape(material, "<Sphere radius='1.3'/>") +
           "</Transform><Transform translation='-1 -1 1' rotation='1 2 3 0.7'>" +
           shape(material, "<Box/>") +
           "</Transform><Transform translation='-2.5 -1 3' scale='0.4 0.7 0.5'>" +
           shape(material, "<Sphere/>") + "</Transform>";
}

TEST(FastShading, LightsDiffuseSurfacesExactly) {
    expect_exact(scene_of("<Background skyColor='0.9 0.7 0.9' groundColor='0.4 0.5 0.7'/>"
                          "<DirectionalLight direction='-1 -2 -1' global='true'/>"
                          "<PointLight location='3 4 5' intensity='0.6'/>" +
                          furniture("diffuseColor='0.8 0.6 0.3'")),
                 "diffuse");
}

TEST(FastShading, ShowsHighlightsOfAnySharpnessExactly) {
    for (const char* shininess : {"0", "0.001", "0.0078125", "0.2", "1"})
        expect_exact(
            scene_of(
                "<DirectionalLight direction='-1 -2 -1' global='true' intensity='0.5'/>"
                "<PointLight location='3 4 5' color='1 0.5 0.2'/>" +
                furniture("diffuseColor='0.3 0.2 0.3' specularColor='0.9 0.6 0.3' shininess='" +
                          std::string(shininess) + "'")),
            std::string("shininess ") + shininess);
}

TEST(FastShading, AttenuatesAndEndsLightsExactly) {
    expect_exact(scene_of("<PointLight location='1 3 2' attenuation='0.5 0.1 0.05' radius='6'/>"
                          "<Transform scale='2 2 2'><PointLight location='-1 1 1' attenuation='0 1 "
                          "0' radius='2' color='0 0.4 1'/></Transform>" +
                          furniture("")),
                 "attenuation");
}

TEST(FastShading, ShinesSpotsExactly) {
    expect_exact(scene_of("<SpotLight location='0 5 3' direction='0 -1 -0.5' beamWidth='0.2' "
                          "cutOffAngle='0.5'/>"
                          "<SpotLight location='-4 1 4' direction='1 -0.4 -1' beamWidth='0.4' "
                          "cutOffAngle='0.3' intensity='0.7' ambientIntensity='0.5'/>"
                          "<SpotLight location='4 3 4' direction='-1 -0.4 -1' beamWidth='1' "
                          "cutOffAngle='1.570796' attenuation='1 0.1 0'/>" +
                          furniture("specularColor='0.5 0.5 0.5' ambientIntensity='0.6'")),
                 "spots");
}

TEST(FastShading, BlendsColorsAndNormalsOfVerticesExactly) {
    expect_exact(
        scene_of("<DirectionalLight direction='0.3 -0.4 -1' global='true'/>"
                 "<PointLight location='3 4 5' intensity='0.6'/>"
                 "<Shape><Appearance><Material specularColor='0.2 0.2 0.2'/></Appearance>"
                 "<IndexedFaceSet solid='false' coordIndex='0 1 2 -1 0 2 3 -1'><Coordinate point="
                 "'-3 -2 0 3 -2 0.5 3 2 -1 -3 2 -2'/><Color color='1 0 0 0 1 0 0 0 1 1 1 0.5'/>"
                 "<Normal vector='-1 -1 1 1 -1 1 2 2 2 -0.01 0.01 0.01'/></IndexedFaceSet></Shape>"
                 "<Transform translation='0 0 -4'><Shape><Appearance><UnlitMaterial "
                 "emissiveColor='0.5 0.5 0.5'/></Appearance><IndexedFaceSet solid='false' "
                 "coordIndex='0 1 2 -1'><Coordinate point='-6 -4 0 6 -4 0 0 5 0'/><Color "
                 "color='1 0 0 0 1 0 0 0 1'/></IndexedFaceSet></Shape></Transform>" +
                 furniture("")),
        "vertices");
}

TEST(FastShading, ShowsGradientsOfSkyAndGroundExactly) {
    expect_exact(
        scene_of("<Viewpoint position='0 0 10' orientation='1 0 0 0.2' fieldOfView='2.5'/>"
                 "<Background skyColor='0 0 1 0.2 0.5 1 1 1 1' skyAngle='0.9 1.4' groundColor='0.2 "
                 "0.1 0 0.5 0.3 0.1 0.9 0.8 0.7' groundAngle='1.1 1.5'/>" +
                 furniture("")),
        "gradients");
    expect_exact(scene_of("<Viewpoint position='0 0 10' orientation='1 0 1 1.4' fieldOfView='2'/>"
                          "<Background skyColor='0 0 1 1 0.5 0 1 1 1' skyAngle='0.2 0.2'/>"),
                 "a step in the sky");
    const std::string view =
        "<Viewpoint position='0 0 10' orientation='1 0 0 -0.6' fieldOfView='2'/>";
    const std::string sky = "<Background skyColor='0 0 1 1 0.5 0 1 1 1' skyAngle='0.9 2.6' ";
    expect_exact(scene_of(view + sky + "groundColor='0 1 0 1 0 1' groundAngle='0.7'/>"),
                 "sky between the ground and the horizon");
    for (const std::string& fields :
         {std::string("<Background skyColor='0.9 0.7 0.9' groundColor='0.4 0.5 0.7'/>"),
          sky + "groundColor='0 1 0'/>", sky + "groundColor='0 1 0 1 0 1' groundAngle='1.2'/>"})
        expect_exact(scene_of(view + "<Transform rotation='2 1 -1 2.2'>" + fields + "</Transform>"),
                     "a background that lies on its side: " + fields);
}

// 0.1, 0.3, 0.5 are halfway between two bytes: ties go up.
TEST(FastShading, RoundsTiesUpWithoutTheFallback) {
    const Scene scene =
        scene_of("<Background skyColor='0.1 0.3 0.5'/>" +
                 shape("diffuseColor='0 0 0' emissiveColor='0.5 0.7 0.9'", "<Sphere radius='2'/>"));
    ShadedPicture picture(scene);
    const Shaded shaded = picture.shade(InstructionSet::kBest);
    EXPECT_EQ(shaded.wrong, 0);
    EXPECT_EQ(shaded.redone, 0);
}

TEST(FastShading, KeepsLightsToTheirScopes) {
    expect_exact(scene_of("<Group><DirectionalLight direction='-1 -1 -1'/>" + furniture("") +
                          "</Group><Transform translation='0 -1 2'><PointLight global='false' "
                          "location='0 3 0'/>" +
                          shape("diffuseColor='1 0 0' emissiveColor='0.1 0 0'", "<Sphere/>") +
                          "</Transform>"),
                 "scopes");
}

TEST(FastShading, SumsMoreLightsThanItHasTablesFor) {
    std::string lights;
    for (int i = 0; i < 20; ++i)
        lights += "<PointLight intensity='0.06' location='" + std::to_string(i - 10) + " 4 5'/>";
    expect_exact(scene_of(lights + furniture("specularColor='0.4 0.4 0.4'")), "20 lights");
}

TEST(FastShading, ShadesTheInsideOfASphere) {
    for (const char* solid : {"true", "false"})
        expect_exact(scene_of("<Viewpoint position='0 0 1'/><PointLight location='0 2 0'/>" +
                              shape("", "<Sphere radius='5' solid='" + std::string(solid) + "'/>")),
                     "inside");
}

TEST(FastShading, ShowsNothingButTheBackgroundWithoutObjects) {
    expect_exact(scene_of("<Background skyColor='0.9 0.7 0.9' groundColor='0.4 0.5 0.7'/>"),
                 "empty");
}

// Random numbers in 0..1 as text.
class RandomText {
  public:
    explicit RandomText(unsigned seed) : random_(seed) {}
    std::string number(double low = 0, double high = 1) {
        return std::to_string(std::uniform_real_distribution<double>(low, high)(random_));
    }
    std::string triple(double low = 0, double high = 1) {
        std::string three = number(low, high);
        for (int i = 1; i < 3; ++i) three += " " + number(low, high);
        return three;
    }

  private:
    std::mt19937 random_;
};

std::string random_nodes(unsigned seed) {
    RandomText r(seed);
    std::ostringstream out;
    out << "<Background skyColor='" << r.triple() << "' groundColor='" << r.triple() << "'/>"
        << "<PointLight location='" << r.triple(-6, 6) << "' color='" << r.triple()
        << "' ambientIntensity='" << r.number() << "'/><SpotLight location='" << r.triple(-6, 6)
        << "' direction='" << r.triple(-1, 1) << "' attenuation='" << r.triple(0, 0.2)
        << "'/><DirectionalLight direction='" << r.triple(-1, 1) << "' intensity='" << r.number()
        << "'/>";
    for (int i = 0; i < 12; ++i) {
        std::ostringstream material;
        material << "diffuseColor='" << r.triple() << "' ambientIntensity='" << r.number()
                 << "' emissiveColor='" << r.triple(0, 0.2)
                 << (i % 3 == 0 ? "' specularColor='" + r.triple() : "") << "' shininess='"
                 << r.number() << "'";
        out << "<Transform translation='" << r.triple(-3, 3) << "' rotation='" << r.triple(-1, 1)
            << " " << r.number(0, 3) << "' scale='"
            << (i % 4 == 1 ? r.triple(0.3, 1) : std::string("1 1 1")) << "'>"
            << shape(material.str(),
                     i % 2 == 0 ? "<Sphere radius='" + r.number(0.05, 1) + "'/>"
                                : "<Cone solid='false' height='" + r.number(0.2, 2) + "'/>")
            << "</Transform>";
    }
    return out.str();
}

TEST(FastShading, ShadesRandomScenesExactly) {
    constexpr unsigned kFirstSeed = 7100;
    for (unsigned seed = kFirstSeed; seed < kFirstSeed + 8; ++seed)
        expect_exact(scene_of(random_nodes(seed)), "seed " + std::to_string(seed));
}

TEST(FastShading, LeavesFewPixelsToTheFallback) {
    const std::string sky = "<Background skyColor='0.9 0.7 0.9' groundColor='0.4 0.5 0.7'/>";
    const std::string lights =
        "<DirectionalLight direction='-1 -2 -1' global='true' intensity='0.5'/>"
        "<PointLight location='3 4 5' intensity='0.5'/>";
    const auto share = [](const Scene& scene) {
        ShadedPicture picture(scene, {480, 270});
        return picture.shade(InstructionSet::kBest).redone / static_cast<double>(picture.pixels());
    };
    EXPECT_LT(share(scene_of(sky + lights + furniture("diffuseColor='0.8 0.6 0.3'"))), 0.005);
    EXPECT_LT(share(scene_of(sky + lights + furniture("specularColor='0.5 0.5 0.5'"))), 0.02);
}

TEST(FastShading, RoundsWhatIsOpenWhereExactnessIsSwitchedOff) {
    const Scene scene = scene_of("<DirectionalLight direction='-1 -2 -1' global='true'/>" +
                                 furniture("diffuseColor='0.8 0.6 0.3'"));
    ShadedPicture picture(scene);
    const Shaded exact = picture.shade(InstructionSet::kBest);
    const Shaded rounded = picture.shade(InstructionSet::kBest, false);
    EXPECT_GT(exact.redone, 0);
    EXPECT_EQ(rounded.redone, 0);
    EXPECT_LE(rounded.wrong, exact.redone);  // whatever was not redone was certain
}

}  // namespace
}  // namespace nuvo
