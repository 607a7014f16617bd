#include <algorithm>
#include <array>
#include <numeric>
#include <unordered_map>
#include <vector>

#include "node_names.h"

namespace nuvo::x3d {

namespace {

// Fields that nodes have in common.
constexpr std::string_view kEveryNode = "DEF USE containerField class id style metadata IS ";
constexpr std::string_view kBounded = "bboxCenter bboxSize bboxDisplay visible render ";
constexpr std::string_view kMoved = "translation rotation scale scaleOrientation center ";
constexpr std::string_view kLight =
    "color intensity ambientIntensity on global shadows shadowIntensity shadowBias shadowMapSize "
    "shadowColor shadowFilterSize shadowOffset shadowCascades shadowSplitFactor shadowSplitOffset "
    "zNear zFar ";
constexpr std::string_view kSet =
    "solid ccw convex colorPerVertex normalPerVertex normalUpdateMode lit ";
constexpr std::string_view kMaterial =
    "ambientIntensity diffuseColor emissiveColor shininess specularColor transparency "
    "normalScale occlusionStrength ";
constexpr std::string_view kRound = "solid subdivision useGeoCache lit ";

using Fields = std::vector<std::string_view>;

Fields words_of(std::initializer_list<std::string_view> lists) {
    Fields fields;
    for (std::string_view list : lists)
        while (!list.empty()) {
            const std::string_view word = list.substr(0, list.find(' '));
            list.remove_prefix(std::min(list.size(), word.size() + 1));
            if (!word.empty()) fields.push_back(word);
        }
    return fields;
}

/// The fields of the nodes that are read, those that are ignored included.
const std::unordered_map<std::string_view, Fields>& node_fields() {
    static const std::unordered_map<std::string_view, Fields> table = [] {
        std::unordered_map<std::string_view, Fields> t;
        const auto put = [&t](std::initializer_list<std::string_view> nodes,
                              std::initializer_list<std::string_view> lists) {
            for (const std::string_view node : nodes) {
                t[node] = words_of(lists);
                const Fields every = words_of({kEveryNode});
                t[node].insert(t[node].end(), every.begin(), every.end());
            }
        };
        put({"Group", "StaticGroup", "PickableGroup", "CADFace", "CADAssembly", "CADLayer", "Layer",
             "HAnimSegment", "ViewpointGroup"},
            {kBounded,
             "name description pickable objectType displayed size center retainUserOffsets "
             "mass centerOfMass momentsOfInertia"});
        put({"Transform", "CADPart", "HAnimJoint", "HAnimSite", "HAnimHumanoid"},
            {kBounded, kMoved,
             "name description info limitOrientation llimit ulimit stiffness "
             "skinCoordIndex skinCoordWeight version loa skeletalConfiguration"});
        put({"Switch"}, {kBounded, "whichChoice"});
        put({"LOD"}, {kBounded, "center range forceTransitions level_changed"});
        put({"Inline"}, {kBounded,
                         "url load global description autoRefresh autoRefreshTimeLimit "
                         "nameSpaceName mapDEFToID"});
        put({"Shape"}, {kBounded, "castShadow isPickable idOffset"});
        put({"Appearance"}, {"alphaMode alphaCutoff sortType sortKey alphaClipThreshold"});
        put({"Material"}, {kMaterial,
                           "backAmbientIntensity backDiffuseColor backEmissiveColor "
                           "backShininess backSpecularColor backTransparency "
                           "separateBackColor"});
        put({"TwoSidedMaterial"}, {kMaterial,
                                   "backAmbientIntensity backDiffuseColor "
                                   "backEmissiveColor backShininess backSpecularColor "
                                   "backTransparency separateBackColor"});
        put({"UnlitMaterial"}, {"emissiveColor transparency normalScale"});
        put({"PhysicalMaterial"}, {"baseColor emissiveColor metallic roughness transparency "
                                   "normalScale occlusionStrength"});
        put({"Sphere"}, {kRound, "radius"});
        put({"Box"}, {kRound, "size"});
        put({"Cone"}, {kRound, "bottomRadius topRadius height bottom side top"});
        put({"Cylinder"}, {kRound, "radius height bottom side top"});
        put({"IndexedFaceSet"},
            {kSet, "coordIndex colorIndex normalIndex texCoordIndex creaseAngle"});
        put({"ElevationGrid"},
            {kSet, "creaseAngle height xDimension xSpacing zDimension zSpacing"});
        put({"Extrusion"}, {"solid ccw convex beginCap endCap creaseAngle crossSection orientation "
                            "scale spine"});
        put({"TriangleSet", "IndexedTriangleSet", "TriangleStripSet", "IndexedTriangleStripSet",
             "TriangleFanSet", "IndexedTriangleFanSet", "QuadSet", "IndexedQuadSet"},
            {kSet, "index stripCount fanCount"});
        put({"Rectangle2D"}, {kRound, "size"});
        put({"Disk2D"}, {kRound, "innerRadius outerRadius"});
        put({"TriangleSet2D"}, {kRound, "vertices"});
        put({"Coordinate", "CoordinateDouble"}, {"point"});
        put({"Normal"}, {"vector"});
        put({"Color", "ColorRGBA"}, {"color"});
        put({"DirectionalLight"}, {kLight, "direction"});
        put({"PointLight"}, {kLight, "attenuation location radius"});
        put({"SpotLight"}, {kLight, "attenuation location radius direction beamWidth cutOffAngle"});
        put({"Viewpoint"}, {"position orientation fieldOfView centerOfRotation description jump "
                            "retainUserOffsets nearDistance farDistance zNear zFar viewAll "
                            "navigationInfo"});
        put({"OrthoViewpoint"}, {"position orientation fieldOfView centerOfRotation description "
                                 "jump retainUserOffsets nearDistance farDistance zNear zFar "
                                 "viewAll navigationInfo"});
        put({"Background", "TextureBackground"},
            {"skyColor skyAngle groundColor groundAngle backUrl bottomUrl frontUrl leftUrl "
             "rightUrl topUrl transparency bindTime isBound crossOrigin"});
        put({"NavigationInfo"},
            {"type speed headlight avatarSize visibilityLimit transitionTime transitionType "
             "transitionComplete blendingSort typeParams explorationMode bindTime isBound"});
        put({"X3D"}, {"version profile"});
        put({"unit"}, {"category name conversionFactor"});
        put({"ProtoInstance", "ProtoDeclare"}, {"name appinfo documentation"});
        put({"ExternProtoDeclare"}, {"name url appinfo documentation"});
        put({"field"}, {"name type value accessType appinfo documentation"});
        put({"fieldValue"}, {"name value"});
        put({"connect"}, {"nodeField protoField"});
        return t;
    }();
    return table;
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool equal_but_for_case(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](char x, char y) { return lower(x) == lower(y); });
}

/// So many letters to leave out, put in, change or swap with the next make `a` of `b`, their case
/// aside (optimal string alignment).
std::size_t distance(std::string_view a, std::string_view b) {
    std::array<std::vector<std::size_t>, 3> rows;  // of the prefixes of a, the latest last
    for (auto& row : rows) row.resize(b.size() + 1);
    std::iota(rows[2].begin(), rows[2].end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::rotate(rows.begin(), rows.begin() + 1, rows.end());
        rows[2][0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t changed = lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1;
            rows[2][j] = std::min({rows[1][j] + 1, rows[2][j - 1] + 1, rows[1][j - 1] + changed});
            if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                lower(a[i - 2]) == lower(b[j - 1]))
                rows[2][j] = std::min(rows[2][j], rows[0][j - 2] + 1);
        }
    }
    return rows[2][b.size()];
}

}  // namespace

std::string_view nearest_name(const std::vector<std::string_view>& names, std::string_view name) {
    // Two slips in a word of six letters or more, one in a shorter one.
    std::size_t nearest = name.size() < 6 ? 2 : 3;
    std::string_view result;
    if (name.size() < 4 || name.size() > 40) return result;
    for (const std::string_view candidate : names) {
        const std::size_t slips = distance(name, candidate);
        if (slips < nearest && candidate.size() > slips + 1) {
            nearest = slips;
            result = candidate;
        }
    }
    return result;
}

FieldName find_field(std::string_view node, std::string_view attribute, bool suggest) {
    const auto known = node_fields().find(node);
    static const Fields every_node = words_of({kEveryNode});
    const Fields& fields = known == node_fields().end() ? every_node : known->second;
    if (std::find(fields.begin(), fields.end(), attribute) != fields.end()) return {attribute, {}};
    for (const std::string_view field : fields)
        if (equal_but_for_case(field, attribute)) return {field, {}};
    if (!suggest || known == node_fields().end()) return {attribute, {}};
    return {attribute, nearest_name(fields, attribute)};
}

}  // namespace nuvo::x3d
