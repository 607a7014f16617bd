// The scenes that the thesis prints, or describes as a change of one value in a printed scene.
#include <string>
#include <string_view>

#include "scenes.h"

namespace nuvo::generator {

namespace {

// Appendices E, F and G as printed, without the line numbers. F's colour is broken over two lines
// there; white space of either kind separates the numbers, so it is kept.
constexpr std::string_view kAppendixE = R"x3d(<Scene>
  <Viewpoint position='0 0 10' />
  <Background groundColor="0.43 0.54 0.72" skyColor="0.9 0.74 0.9" />
  <DirectionalLight direction='0 -1 0' />
  <Transform translation='0 0 0'>
    <Shape>
      <Sphere radius='4' />
      <Appearance>
        <Material diffuseColor='1.0 0 0' />
      </Appearance>
    </Shape>
  </Transform>
</Scene>
)x3d";

constexpr std::string_view kAppendixF = R"x3d(<Scene>
  <Viewpoint position='0 0 10' />
  <Background groundColor="0.43 0.54 0.72"
    skyColor="0.9 0.74 0.9" />
  <SpotLight direction='0 0 -1' location='0 0 10' cutOffAngle='0.3' color='1 1
    1' beamWidth='0.1' />
  <Transform translation='0 0 0'>
    <Shape>
      <Sphere radius='4' />
      <Appearance>
        <Material diffuseColor='1.0 0 0' />
      </Appearance>
    </Shape>
  </Transform>
</Scene>
)x3d";

constexpr std::string_view kAppendixG = R"x3d(<Scene>
  <Viewpoint position='0 0 10' fieldOfView='1'/>
  <Background groundColor="0.43 0.54 0.72" skyColor="0.9 0.74 0.9"/>
  <SpotLight direction='0 0 -1' location='0 0 10' cutOffAngle='0.45'
    color='0.5 0.5 0.5' beamWidth='0.3'/>
  <Transform translation='2 2 0'>
    <Shape>
      <Sphere radius='2'/>
      <Appearance>
        <Material diffuseColor='1.0 0 0'/>
      </Appearance>
    </Shape>
  </Transform>
  <Transform translation='-2 2 0'>
    <Shape>
      <Sphere radius='2'/>
      <Appearance>
        <Material diffuseColor='0 1 0'/>
      </Appearance>
    </Shape>
  </Transform>
  <Transform translation='2 -2 0'>
    <Shape>
      <Sphere radius='2'/>
      <Appearance>
        <Material diffuseColor='0 0 1'/>
      </Appearance>
    </Shape>
  </Transform>
  <Transform translation='-2 -2 0'>
    <Shape>
      <Sphere radius='2'/>
      <Appearance>
        <Material diffuseColor='0.5 0.5 0.5'/>
      </Appearance>
    </Shape>
  </Transform>
</Scene>
)x3d";

/// `text` with its one occurrence of `from` replaced.
std::string replaced(std::string text, std::string_view from, std::string_view to) {
    return text.replace(text.find(from), from.size(), to);
}

/// Appendix G under another light and another field of view.
std::string four_spheres(std::string_view color, std::string_view field_of_view) {
    const std::string text = replaced(std::string(kAppendixG), "fieldOfView='1'",
                                      "fieldOfView='" + std::string(field_of_view) + "'");
    return replaced(text, " color='0.5 0.5 0.5'", " color='" + std::string(color) + "'");
}

}  // namespace

std::string appendix_e(const Variation&) { return std::string(kAppendixE); }

std::string appendix_f(const Variation&) { return std::string(kAppendixF); }

std::string appendix_g(const Variation&) { return std::string(kAppendixG); }

std::string figure_25(const Variation&) {
    return replaced(std::string(kAppendixF),
                    "cutOffAngle='0.3' color='1 1\n    1' beamWidth='0.1' />", "color='1 1 1' />");
}

std::string figure_22(const Variation&) {
    const std::string text = replaced(std::string(kAppendixG),
                                      "SpotLight direction='0 0 -1' location='0 0 10' "
                                      "cutOffAngle='0.45'\n    color='0.5 0.5 0.5' beamWidth='0.3'",
                                      "DirectionalLight direction='-1 -1 -1'");
    return text;
}

std::string figure_27(const Variation&) { return four_spheres("1 0 0", "0.7"); }

std::string figure_28(const Variation&) { return four_spheres("0 1 0", "0.8"); }

std::string figure_29(const Variation&) { return four_spheres("0 0 1", "0.9"); }

}  // namespace nuvo::generator
