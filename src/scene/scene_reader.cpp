#include "scene_reader.h"

#include <algorithm>
#include <cmath>

#include "children.h"
#include "view.h"

namespace nuvo::x3d {

namespace {

/// True for what can be the geometry of a Shape.
bool is_geometry(std::string_view kind) {
    return kind == "Sphere" || is_mesh(kind) || is_undrawn_geometry(kind);
}

}  // namespace

Scene SceneReader::read(const Document& document) {
    version_ = document.version;
    file_ = document.name;
    length_unit_ = document.units.length;
    scene_.objects.reserve(document.extent.shapes);
    begin(options_.progress, "shapes", document.extent.shapes);
    if (documents_.has_levels()) find_camera_first(*document.scene);
    read_children(*document.scene, {});
    check_viewpoint();
    warn_of_idle_lights();
    add_headlight();
    if (options_.shape_names != nullptr) options_.shape_names->resize(scene_.shape_count);
    scene_.materials = materials_.take();
    scene_.warnings = messages_.warnings();
    return std::move(scene_);
}

void SceneReader::warn_of_idle_lights() {
    std::vector<Bounds3> boxes;
    std::size_t tests_left = 10'000'000;
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
        const Light& light = scene_.lights[i];
        const std::size_t last = std::min<std::size_t>(light.scope.last, scene_.objects.size());
        bool is_idle = light.scope.first >= light.scope.last;
        if (!is_idle && light.scope.first < last && light.kind != Light::Kind::kDirectional) {
            if (boxes.empty())
                for (const Object& object : scene_.objects) boxes.push_back(bounds(object.shape));
            std::size_t object = light.scope.first;
            for (; object < last && tests_left > 0; ++object, --tests_left)
                if (may_reach(light, boxes[object])) break;
            is_idle = object == last;
        }
        if (is_idle) messages_.warn(light_nodes_[i]->name, "reaching no shape", *light_nodes_[i]);
    }
}

void SceneReader::find_camera_first(const Element& scene) {
    looking_for_camera_ = true;
    messages_.set_muted(true);
    read_children(scene, {});
    messages_.set_muted(false);
    looking_for_camera_ = false;
    scene_.camera_given = false;
    scene_.viewpoints.clear();
}

void SceneReader::check_viewpoint() const {
    const std::string& wanted = options_.viewpoint;
    if (scene_.camera_given || wanted.empty() || wanted == kStandardView || wanted == kFittedView)
        return;
    std::string names;
    for (const std::string& name : scene_.viewpoints) names += " " + excerpt(name);
    throw Error(file_ + ": has no Viewpoint \"" + excerpt(options_.viewpoint) + "\" among its " +
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
    if (is_listing(child)) return;
    const Element& node = child.node();
    const NodeKind kind = node_kind(node.name);
    if (kind == NodeKind::kNotDrawn) {
        if (!is_silent(node.name)) warn_not_drawn(child, messages_);
        return;
    }
    if (is_drawable(kind) &&
        (is_proxy(child) || !Fields(node, messages_).boolean("visible", true))) {
        count_hidden(child);
        return;
    }
    const bool may_view =
        (is_drawable(kind) && kind != NodeKind::kShape) || kind == NodeKind::kViewpoint;
    if (looking_for_camera_ && !may_view) return;
    if (kind == NodeKind::kGroup || kind == NodeKind::kTransform)
        if (const std::string_view missing = missing_part(node.name); !missing.empty())
            messages_.warn(node.name, missing, child);
    const std::string_view around = name_;
    if (const std::string_view name = node.text("DEF"); !name.empty()) name_ = name;
    try {
        read_node(kind, node, group);
    } catch (const LeftOut& left_out) {
        messages_.warn_left_out(node.name, left_out);
    }
    name_ = around;
}

void SceneReader::read_node(NodeKind kind, const Element& node, Group& group) {
    switch (kind) {
        case NodeKind::kNotDrawn:
            return;
        case NodeKind::kGroup:
            return read_children(node, group.placement);
        case NodeKind::kTransform:
        case NodeKind::kHumanoid:
            return read_children(node, group.placement.inside(Fields(node, messages_)));
        case NodeKind::kLayers:
            return read_layers(node, group);
        case NodeKind::kSwitch:
            return read_switch(node, group);
        case NodeKind::kLod:
            return read_level_of_detail(node, group);
        case NodeKind::kInline:
            return read_inline(node, group);
        case NodeKind::kShape:
            return read_shape(node, group);
        case NodeKind::kDirectionalLight:
            return add_light(Light::Kind::kDirectional, node, group);
        case NodeKind::kPointLight:
            return add_light(Light::Kind::kPoint, node, group);
        case NodeKind::kSpotLight:
            return add_light(Light::Kind::kSpot, node, group);
        case NodeKind::kViewpoint:
            return read_viewpoint_node(node, group);
        case NodeKind::kBackground:
            return read_background_node(node, group);
        case NodeKind::kNavigationInfo:
            return read_navigation_info(node);
    }
}

void SceneReader::count_hidden(const Element& node) {
    if (!looking_for_camera_) scene_.shape_count += count_shapes(node, documents_);
}

void SceneReader::read_layers(const Element& node, Group& group) {
    const std::vector<bool> is_drawn = drawn_layers(node, Fields(node, messages_));
    std::size_t i = 0;
    for (const Element& layer : node.children) {
        if (is_drawn[i++]) {
            read_child(layer, group);
            continue;
        }
        if (is_drawable(node_kind(layer.kind())))
            messages_.warn(layer.kind(), "not in the order of its LayerSet: not drawn", layer);
        count_hidden(layer);
    }
}

void SceneReader::read_switch(const Element& node, Group& group) {
    read_only(chosen_child(node, Fields(node, messages_)), node, group.placement);
}

void SceneReader::read_level_of_detail(const Element& node, Group& group) {
    const Fields fields(node, messages_);
    // A camera inside an LOD would have to be known before it is: it counts in the first level.
    const Element* level =
        looking_for_camera_ ? child_at(node, 0)
                            : chosen_level(node, fields, group.placement, scene_.camera.position);
    read_only(level, node, group.placement);
}

void SceneReader::read_inline(const Element& node, Group& group) {
    const Document* document = documents_.inlined(node);
    if (document == nullptr) return;
    const double scale = document->units.length / length_unit_;
    if (!std::isfinite(scale) || scale == 0)
        Fields(node, messages_).fail("url", "its file's unit of length is beyond double here");
    const Version outer = version_;
    version_ = document->version;
    ++inline_depth_;
    read_children(*document->scene, group.placement.scaled(scale));
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
    add(options_.progress, 1);
    if (options_.shape_names != nullptr) {
        options_.shape_names->resize(shape_index);  // those before it that are not drawn have none
        options_.shape_names->emplace_back(name_);
    }
    const Element* appearance = nullptr;
    const Element* geometry = nullptr;
    for (const Element& child : node.children) {
        const std::string_view kind = child.kind();
        if (is_silent(kind)) continue;
        if (kind != "Appearance" && !is_geometry(kind)) {
            warn_not_drawn(child, messages_);
            continue;
        }
        const Element*& place = kind == "Appearance" ? appearance : geometry;
        if (place == nullptr)
            place = &child.node();
        else if (messages_.is_strict())
            messages_.refuse(child, "", "is beyond the first of its Shape");
        else
            messages_.warn(kind, "beyond the first of its Shape left out", child);
    }
    if (geometry != nullptr && appearance == nullptr) appearance = appearance_inside(*geometry);
    const std::optional<std::uint32_t> material = materials_.look_up(appearance);
    if (!material || geometry == nullptr) return;
    std::optional<Shape> shape = read_geometry(*geometry, group.placement);
    if (!shape) return;
    Object object{std::move(*shape), *material, shape_index};
    object.solid = Fields(*geometry, messages_).boolean("solid", !geometry->name.ends_with("2D"));
    object.casts_shadow = Fields(node, messages_).boolean("castShadow", true);
    if (options_.defaults.drops_repeats && repeats_.is_repeat(object, scene_.objects)) {
        messages_.warn(geometry->name, "exactly where an earlier one is, so never seen, left out",
                       node);
        return;
    }
    if (materials_.is_of_no_node(*material))
        messages_.warn(node.name, "without a Material drawn unlit, white or in colors of its own",
                       node);
    scene_.objects.push_back(std::move(object));
}

// The published program's own scenes have it there.
const Element* SceneReader::appearance_inside(const Element& geometry) {
    for (const Element& child : geometry.children)
        if (child.kind() == "Appearance") {
            messages_.warn("Appearance", "inside a geometry: taken for its Shape", child);
            return &child.node();
        }
    return nullptr;
}

std::optional<Shape> SceneReader::read_geometry(const Element& node, const Placement& placement) {
    if (node.name == "Sphere") return read_sphere(node, placement);
    if (is_mesh(node.name)) return read_mesh(node, placement, options_, messages_, vertices_);
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

void SceneReader::add_light(Light::Kind kind, const Element& node, Group& group) {
    const Fields fields(node, messages_);
    const std::optional<PlacedLight> placed =
        read_light(kind, fields, group.placement, version_, options_.defaults);
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
    if (scene_.camera_given || !is_wanted(node, scene_.viewpoints.size(), options_.viewpoint))
        return;
    scene_.camera = read_viewpoint(Fields(node, messages_), group.placement, options_.defaults);
    scene_.camera_given = true;
}

void SceneReader::read_background_node(const Element& node, const Group& group) {
    if (has_background_ || inline_depth_ > 0) return;
    has_background_ = true;
    for (const Element& child : node.children)  // a TextureBackground's pictures
        if (!is_silent(child.kind())) warn_not_drawn(child, messages_);
    scene_.background = read_background(Fields(node, messages_), group.placement);
}

void SceneReader::read_navigation_info(const Element& node) {
    if (headlight_ || inline_depth_ > 0) return;
    headlight_ = Fields(node, messages_).boolean("headlight", true);
}

void SceneReader::add_headlight() {
    const bool automatic = headlight_.value_or(scene_.lights.empty());
    const Headlight wish = options_.headlight;
    if (wish == Headlight::kOff || (wish == Headlight::kAuto && !automatic)) return;
    Light light;
    light.direction = scene_.camera.forward;
    light.casts_shadow = false;
    scene_.lights.push_back(light);
}

}  // namespace nuvo::x3d
