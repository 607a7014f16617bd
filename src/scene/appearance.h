#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "messages.h"
#include "nuvo/scene/defaults.h"
#include "nuvo/scene/material.h"

namespace nuvo::x3d {

/// The scene's materials, one for each Material node however often it is USEd.
class MaterialTable {
  public:
    MaterialTable(Messages& messages, const Defaults& defaults)
        : messages_(messages), defaults_(defaults) {}

    /// The index of the material that an Appearance gives (null: no Appearance, so unlit white);
    /// nothing when it is wholly transparent.
    std::optional<std::uint32_t> look_up(const Element* appearance);

    /// True for the unlit white of Shapes without a Material.
    bool is_of_no_node(std::uint32_t material) const {
        const auto found = known_.find(nullptr);
        return found != known_.end() && found->second == material;
    }

    std::vector<Material> take() { return std::move(materials_); }

  private:
    std::uint32_t add(const Material& material);
    std::optional<std::uint32_t> read(const Element& material);

    Messages& messages_;
    const Defaults& defaults_;
    std::vector<Material> materials_;
    // By node; the null node stands for the unlit white.
    std::unordered_map<const Element*, std::optional<std::uint32_t>> known_;
};

}  // namespace nuvo::x3d
