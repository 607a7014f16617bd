#include "appearance.h"

#include "fields.h"
#include "node_names.h"

namespace nuvo::x3d {

namespace {

/// Without a Material a Shape is white whatever the lights.
Material unlit_white() {
    Material material;
    material.emissive_color = {1, 1, 1};
    material.lit = false;
    return material;
}

bool is_material(std::string_view name) {
    return name == "Material" || name == "UnlitMaterial" || name == "PhysicalMaterial" ||
           name == "TwoSidedMaterial";
}

/// X3D 4's material for the back side only.
bool is_back(const Element& child) {
    const std::string_view* field = child.find("containerField");
    return field != nullptr && *field == "backMaterial";
}

void read_phong(const Fields& fields, const Defaults& defaults, Material& material) {
    material.diffuse_color = fields.clamped_vector("diffuseColor", material.diffuse_color, kUnit);
    material.ambient_intensity =
        fields.clamped_number("ambientIntensity", material.ambient_intensity, kUnit);
    if (!defaults.has_material_ambient) material.ambient_intensity = 1;
    material.specular_color =
        fields.clamped_vector("specularColor", defaults.specular_color, kUnit);
    material.shininess = fields.clamped_number("shininess", material.shininess, kUnit);
    material.emissive_color =
        fields.clamped_vector("emissiveColor", material.emissive_color, kUnit);
    if (fields.boolean("separateBackColor", false))
        fields.warn("separateBackColor", "of true: its back is drawn as its front");
}

}  // namespace

std::optional<std::uint32_t> MaterialTable::look_up(const Element* appearance) {
    const Element* material = nullptr;
    if (appearance != nullptr) {
        for (const Element& child : appearance->children) {
            if (is_material(child.kind()) && material == nullptr && !is_back(child))
                material = &child.node();
            else if (!is_silent(child.kind()))
                warn_not_drawn(child, messages_);
        }
    }
    const auto [entry, is_new] = known_.try_emplace(material);
    if (is_new) entry->second = material != nullptr ? read(*material) : add(unlit_white());
    return entry->second;
}

std::uint32_t MaterialTable::add(const Material& material) {
    materials_.push_back(material);
    return static_cast<std::uint32_t>(materials_.size() - 1);
}

std::optional<std::uint32_t> MaterialTable::read(const Element& element) {
    const Fields fields(element, messages_);
    Material material;
    if (element.name == "UnlitMaterial") {
        material = unlit_white();
        material.emissive_color = fields.clamped_vector("emissiveColor", {1, 1, 1}, kUnit);
    } else if (element.name == "PhysicalMaterial") {
        messages_.warn(element.name, "drawn as a matt Material of its baseColor", element);
        material.diffuse_color = fields.clamped_vector("baseColor", {1, 1, 1}, kUnit);
        material.emissive_color = fields.clamped_vector("emissiveColor", {0, 0, 0}, kUnit);
    } else {
        read_phong(fields, defaults_, material);
    }
    for (const Element& child : element.children)
        if (!is_silent(child.kind())) warn_not_drawn(child, messages_);
    const double transparency = fields.clamped_number("transparency", 0, kUnit);
    if (transparency == 1) {
        fields.warn("transparency", "of 1: not drawn");
        return std::nullopt;
    }
    if (transparency > 0) fields.warn("transparency", "between 0 and 1: drawn opaque");
    return add(material);
}

}  // namespace nuvo::x3d
