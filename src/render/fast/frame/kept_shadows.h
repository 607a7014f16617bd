#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "fast/shadow/shadow_tables.h"

namespace nuvo {

/// Shadow tables of all items, which do not depend on the camera: for the next pictures of a scene
/// whose lights stay where they are.
class KeptShadows {
  public:
    /// Null: there are none for these lights.
    const ShadowTables* find(const std::vector<Light>& lights) const {
        return tables_ && lights_ == lights ? &*tables_ : nullptr;
    }
    /// Keeps what `fill` puts into empty tables.
    template <typename Fill>
    const ShadowTables& make(const FastScene& scene, InstructionSet isa, int threads, Fill&& fill) {
        tables_.reset();
        ShadowTables tables(scene, isa, threads);
        fill(tables);
        lights_ = scene.scene().lights;
        return tables_.emplace(std::move(tables));
    }

  private:
    std::vector<Light> lights_;
    std::optional<ShadowTables> tables_;
};

}  // namespace nuvo
