#pragma once

#include <string_view>
#include <vector>

#include "messages.h"

namespace nuvo::x3d {

/// What the scene graph knows a node as: how its kind is read.
enum class NodeKind {
    kNotDrawn,
    kGroup,      ///< a grouping node, or what is read as one
    kTransform,  ///< one that moves its children by the fields of a Transform
    kHumanoid,   ///< HAnimHumanoid: a Transform that lists its parts a second time
    kLayers,     ///< LayerSet
    kSwitch,
    kLod,
    kInline,
    kShape,
    kDirectionalLight,
    kPointLight,
    kSpotLight,
    kViewpoint,
    kBackground,
    kNavigationInfo
};

/// The kind of a node of the scene graph, by its name.
NodeKind node_kind(std::string_view name);

/// What a grouping node is drawn without, for a warning; empty where nothing is missing.
std::string_view missing_part(std::string_view name);

/// True for kinds that hold Shapes: all groups, and a Shape itself.
inline bool is_drawable(NodeKind kind) {
    return kind >= NodeKind::kGroup && kind <= NodeKind::kShape;
}

/// True for geometry that is not drawn, as Text is: it takes its Shape's place for geometry.
bool is_undrawn_geometry(std::string_view name);

/// True for what is no drawable content and so needs no word when it is passed over: metadata,
/// declarations, texture coordinates.
bool is_silent(std::string_view name);

/// The spelling that X3D gives the name of a node or a statement; empty where no name of X3D is
/// like it but for the case of its letters.
std::string_view right_spelling(std::string_view name);

/// What stands for an attribute of a node. `name` is the field's own where only the case of its
/// letters was wrong; `suggestion` is the field that was probably meant where the node has none of
/// that name, which is looked for if `suggest`.
struct FieldName {
    std::string_view name;
    std::string_view suggestion;
};
FieldName find_field(std::string_view node, std::string_view attribute, bool suggest);

/// The one of `names` from which `name` differs by a slip or two; empty where there is none.
std::string_view nearest_name(const std::vector<std::string_view>& names, std::string_view name);

/// Warns that a node is not drawn, unless its name is misspelt.
void warn_not_drawn(const Element& element, Messages& messages);

/// Throws Error with the right spelling where a name differs from a node's in case only.
void refuse_misspelt(const Element& element, const Messages& messages);

}  // namespace nuvo::x3d
