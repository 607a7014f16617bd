#include "scene_reader.h"

#include <cmath>
#include <unordered_map>

#include "children.h"
#include "node_names.h"
#include "view.h"

namespace nuvo::x3d {

const SceneReader::Kind* SceneReader::kind_of(std::string_view name) {
    using Role = Kind::Role;
    static const std::unordered_map<std::string_view, Kind> kinds{
        {"Anchor", {&SceneReader::read_group, Role::kGroup}},
        {"Background", {&SceneReader::read_background_node, Role::kOther}},
        {"Billboard", {&SceneReader::read_group, Role::kGroup}},
        {"CADAssembly", {&SceneReader::read_group, Role::kGroup}},
        {"CADFace", {&SceneReader::read_group, Role::kGroup}},
        {"CADLayer", {&SceneReader::read_group, Role::kGroup}},
        {"CADPart", {&SceneReader::read_transform, Role::kGroup}},
        {"Collision", {&SceneReader::read_group, Role::kGroup}},
        {"DirectionalLight", {&SceneReader::read_directional_light, Role::kOther}},
        {"Group", {&SceneReader::read_group, Role::kGroup}},
        {"Inline", {&SceneReader::read_inline, Role::kGroup}},
        {"LOD", {&SceneReader::read_level_of_detail, Role::kGroup}},
        {"NavigationInfo", {&SceneReader::read_navigation_info, Role::kOther}},
        {"PointLight", {&SceneReader::read_point_light, Role::kOther}},
        {"Shape", {&SceneReader::read_shape, Role::kShape}},
        {"SpotLight", {&SceneReader::read_spot_light, Role::kOther}},
        {"StaticGroup", {&SceneReader::read_group, Role::kGroup}},
        {"Switch", {&SceneReader::read_switch, Role::kGroup}},
        {"Transform", {&SceneReader::read_transform, Role::kGroup}},
        {"Viewpoint", {&SceneReader::read_viewpoint_node, Role::kView}},
    };
    const auto found = kinds.find(name);
    return found == kinds.end() ? nullptr : &found->second;
}

Scene SceneReader::read(const Document& document, Headlight headlight,
                        const std::string& viewpoint) {
    wanted_viewpoint_ = viewpoint;
    version_ = document.version;
    file_ = document.name;
    if (documents_.has_levels()) find_camera_first(*document.scene);
    read_children(*document.scene, {});
    check_viewpoint();
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
        const LightScope& scope = scene_.lights[i].scope;
        if (scope.first >= scope.last)
            messages_.warn(light_nodes_[i]->name, "reaching no shape", *light_nodes_[i]);
    }
    add_headlight(headlight);
    scene_.materials = materials_.take();
    scene_.warnings = messages_.warnings();
    return std::move(scene_);
}

void SceneReader::find_camera_first(const Element& scene) {
    looking_for_camera_ = true;
    messages_.set_muted(true);
    read_children(scene, {});
    messages_.set_muted(false);
    looking_for_camera_ = false;
    has_viewpoint_ = false;
    scene_.viewpoints.clear();
}

void SceneReader::check_viewpoint() const {
    if (has_viewpoint_ || wanted_viewpoint_.empty()) return;
    std::string names;
    for (const std::string& name : scene_.viewpoints) names += " " + excerpt(name);
    throw Error(file_ + ": has no Viewpoint \"" + excerpt(wanted_viewpoint_) + "\" among its " +
                std::to_string(scene_.viewpoints.size()) + (names.empty() ? "" : ":" + names));
}

void SceneReader::read_children(const Element& parent, const Placement& placement) {
    Group group{placement, {}};
    const std::size_t first_object = scene_.objects.size();
    for (const Element& child : parent.children) read_child(child, group);
    close_scopes(group, first_object);
}

void SceneReader::read_only(const Element* chosen, const Element& parent,
                            const Placement& placement) {
    Group group{placement, {}};
    const std::size_t first_object = scene_.objects.size();
    for (const Element& child : parent.children) {
        if (&child == chosen)
            read_child(child, group);
        else
            count_hidden(child);
    }
    close_scopes(group, first_object);
}

void SceneReader::read_child(const Element& child, Group& group) {
    const Kind* kind = kind_of(child.name);
    if (kind == nullptr) {
        if (!is_silent(child.name)) warn_not_drawn(child, messages_);
        return;
    }
    const bool drawable = kind->role == Kind::Role::kGroup || kind->role == Kind::Role::kShape;
    if (drawable &&
        (is_proxy(child) || !Fields(child.node(), messages_).boolean("visible", true))) {
        count_hidden(child);
        return;
    }
    const bool may_view = kind->role == Kind::Role::kGroup || kind->role == Kind::Role::kView;
    if (!looking_for_camera_ || may_view) (this->*kind->handler)(child.node(), group);
}

void SceneReader::count_hidden(const Element& node) {
    if (!looking_for_camera_) scene_.shape_count += count_shapes(node, documents_);
}

void SceneReader::read_group(const Element& node, Group& group) {
    read_children(node, group.placement);
}

void SceneReader::read_transform(const Element& node, Group& group) {
    read_children(node, group.placement.inside(Fields(node, messages_)));
}

void SceneReader::read_switch(const Element& node, Group& group) {
    read_only(chosen_child(node, Fields(node, messages_)), node, group.placement);
}

void SceneReader::read_level_of_detail(const Element& node, Group& group) {
    const Fields fields(node, messages_);
    // A camera inside an LOD would have to be known before it is: it counts in the first level.
    const Element* level =
        looking_for_camera_ ? drawn_child(node, 0)
                            : chosen_level(node, fields, group.placement, scene_.camera.position);
    read_only(level, node, group.placement);
}

void SceneReader::read_inline(const Element& node, Group& group) {
    const Document* document = documents_.inlined(node);
    if (document == nullptr) return;
    const Version outer = version_;
    version_ = document->version;
    ++inline_depth_;
    read_children(*document->scene, group.placement);
    --inline_depth_;
    version_ = outer;
}

void SceneReader::close_scopes(const Group& group, std::size_t first_object) {
    for (const std::size_t light : group.scoped_lights)
        scene_.lights[light].scope = {static_cast<std::uint32_t>(first_object),
                                      static_cast<std::uint32_t>(scene_.objects.size())};
}

void SceneReader::read_shape(const Element& node, Group& group) {
    const auto shape_index = static_cast<std::uint32_t>(scene_.shape_count++);
    const Element* appearance = nullptr;
    const Element* geometry = nullptr;
    for (const Element& child : node.children) {
        if (is_silent(child.name)) continue;
        if (child.name == "Appearance" && appearance == nullptr)
            appearance = &child.node();
        else if (child.name != "Appearance" && geometry == nullptr)
            geometry = &child.node();
        else
            messages_.warn(excerpt(child.name), "beyond the first of its Shape left out", child);
    }
    const std::optional<std::uint32_t> material = materials_.look_up(appearance);
    if (!material || geometry == nullptr) return;
    std::optional<Shape> shape = read_geometry(*geometry, group.placement);
    if (!shape) return;
    if (repeats_.is_repeat(*shape, scene_.objects)) {
        messages_.warn(geometry->name, "exactly where an earlier one is, so never seen, left out",
                       node);
        return;
    }
    const bool solid = Fields(*geometry, messages_).boolean("solid", true);
    scene_.objects.push_back({std::move(*shape), *material, shape_index, solid});
}

std::optional<Shape> SceneReader::read_geometry(const Element& node, const Placement& placement) {
    if (node.name == "Sphere") return read_sphere(node, placement);
    if (is_mesh(node.name)) return read_mesh(node, placement, messages_, vertices_);
    warn_not_drawn(node, messages_);
    return std::nullopt;
}

std::optional<Shape> SceneReader::read_sphere(const Element& node, const Placement& placement) {
    const Fields fields(node, messages_);
    const double radius = fields.number("radius", 1);
    if (radius < 0) fields.fail("radius", "is negative");
    if (radius == 0) {
        fields.warn("radius", "of zero: not drawn");
        return std::nullopt;
    }
    const Point3 center = placement.to_world.translation;
    const double world_radius = radius * placement.length_scale;
    const Matrix3& linear = placement.to_world.linear;
    if (!is_finite(center) || !std::isfinite(world_radius) || !is_finite(linear.row[0]) ||
        !is_finite(linear.row[1]) || !is_finite(linear.row[2]))
        fields.fail("radius", "beyond the range of double in world space");
    if (placement.singular || world_radius == 0) {
        messages_.warn(node.name, "flattened by a scale of zero: not drawn", node);
        return std::nullopt;
    }
    if (placement.uniform) return Sphere{center, world_radius};
    return Ellipsoid{center, linear, radius};
}

void SceneReader::read_directional_light(const Element& node, Group& group) {
    add_light(Light::Kind::kDirectional, node, group);
}

void SceneReader::read_point_light(const Element& node, Group& group) {
    add_light(Light::Kind::kPoint, node, group);
}

void SceneReader::read_spot_light(const Element& node, Group& group) {
    add_light(Light::Kind::kSpot, node, group);
}

void SceneReader::add_light(Light::Kind kind, const Element& node, Group& group) {
    const Fields fields(node, messages_);
    const std::optional<PlacedLight> placed = read_light(kind, fields, group.placement, version_);
    if (!placed) return;
    const Light& light = placed->light;
    if (!is_finite(light.location) || !is_finite(light.direction) || !std::isfinite(light.radius) ||
        !std::isfinite(light.units_per_world))
        fields.fail("", "beyond the range of double in world space");
    if (placed->scoped) group.scoped_lights.push_back(scene_.lights.size());
    scene_.lights.push_back(light);
    light_nodes_.push_back(&node);
}

void SceneReader::read_viewpoint_node(const Element& node, Group& group) {
    if (inline_depth_ > 0) return;
    scene_.viewpoints.push_back(viewpoint_name(node, scene_.viewpoints.size() + 1));
    if (has_viewpoint_ || !is_wanted(node, scene_.viewpoints.size(), wanted_viewpoint_)) return;
    has_viewpoint_ = true;
    scene_.camera = read_viewpoint(Fields(node, messages_), group.placement);
}

void SceneReader::read_background_node(const Element& node, Group&) {
    if (has_background_ || inline_depth_ > 0) return;
    has_background_ = true;
    scene_.background = read_background(Fields(node, messages_));
}

void SceneReader::read_navigation_info(const Element& node, Group&) {
    if (headlight_ || inline_depth_ > 0) return;
    headlight_ = Fields(node, messages_).boolean("headlight", true);
}

void SceneReader::add_headlight(Headlight headlight) {
    const bool automatic = headlight_.value_or(scene_.lights.empty());
    if (headlight == Headlight::kOff || (headlight == Headlight::kAuto && !automatic)) return;
    Light light;
    light.direction = scene_.camera.forward;
    light.casts_shadow = false;
    scene_.lights.push_back(light);
}

}  // namespace nuvo::x3d
