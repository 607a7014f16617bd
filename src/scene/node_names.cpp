#include "node_names.h"

#include <algorithm>
#include <array>
#include <unordered_set>

namespace nuvo::x3d {

namespace {

const std::unordered_set<std::string_view> kSilent{"ExternProtoDeclare",
                                                   "MetadataBoolean",
                                                   "MetadataDouble",
                                                   "MetadataFloat",
                                                   "MetadataInteger",
                                                   "MetadataSet",
                                                   "MetadataString",
                                                   "MultiTextureCoordinate",
                                                   "ProtoDeclare",
                                                   "TextureCoordinate",
                                                   "TextureCoordinate3D",
                                                   "TextureCoordinate4D",
                                                   "TextureCoordinateGenerator",
                                                   "WorldInfo",
                                                   "component",
                                                   "head",
                                                   "meta",
                                                   "unit"};

constexpr auto kNodes = std::to_array<std::string_view>({"Anchor",
                                                         "Appearance",
                                                         "Background",
                                                         "Billboard",
                                                         "Box",
                                                         "CADAssembly",
                                                         "CADFace",
                                                         "CADLayer",
                                                         "CADPart",
                                                         "Collision",
                                                         "Color",
                                                         "ColorRGBA",
                                                         "Cone",
                                                         "Coordinate",
                                                         "CoordinateDouble",
                                                         "Cylinder",
                                                         "DirectionalLight",
                                                         "ElevationGrid",
                                                         "Extrusion",
                                                         "FillProperties",
                                                         "Fog",
                                                         "Group",
                                                         "ImageTexture",
                                                         "IndexedFaceSet",
                                                         "IndexedLineSet",
                                                         "IndexedQuadSet",
                                                         "IndexedTriangleFanSet",
                                                         "IndexedTriangleSet",
                                                         "IndexedTriangleStripSet",
                                                         "Inline",
                                                         "LOD",
                                                         "LineProperties",
                                                         "LineSet",
                                                         "Material",
                                                         "MovieTexture",
                                                         "MultiTexture",
                                                         "NavigationInfo",
                                                         "Normal",
                                                         "OrthoViewpoint",
                                                         "PhysicalMaterial",
                                                         "PixelTexture",
                                                         "PointLight",
                                                         "PointSet",
                                                         "ProtoInstance",
                                                         "QuadSet",
                                                         "Scene",
                                                         "Script",
                                                         "Shape",
                                                         "Sphere",
                                                         "SpotLight",
                                                         "StaticGroup",
                                                         "Switch",
                                                         "Text",
                                                         "TextureTransform",
                                                         "Transform",
                                                         "TriangleFanSet",
                                                         "TriangleSet",
                                                         "TriangleStripSet",
                                                         "TwoSidedMaterial",
                                                         "UnlitMaterial",
                                                         "Viewpoint",
                                                         "X3D"});

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool equal_but_for_case(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

bool is_silent(std::string_view name) { return kSilent.contains(name); }

void warn_not_drawn(const Element& element, Messages& messages) {
    if (messages.warn(excerpt(element.name), "not drawn", element))
        refuse_misspelt(element, messages);
}

void refuse_misspelt(const Element& element, const Messages& messages) {
    const auto* node = std::find_if(kNodes.begin(), kNodes.end(), [&](std::string_view known) {
        return known != element.name && equal_but_for_case(known, element.name);
    });
    if (node != kNodes.end())
        messages.fail(element, "", "no node of X3D, which spells it " + std::string(*node));
}

}  // namespace nuvo::x3d
