#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "fast/shadow/shadow_tables.h"

namespace nuvo {

/// The shadow tables of the last picture, for the next ones of a scene whose lights stay where they
/// are: those of all items do not depend on the camera, others serve points for which they are
/// known to list enough.
class KeptShadows {
  public:
    /// Null: there are none for these lights.
    const ShadowTables* find(const std::vector<Light>& lights) const {
        return tables_ && lights_ == lights ? &*tables_ : nullptr;
    }
    /// Frees what is kept, and keeps what `make` returns instead.
    template <typename Make>
    const ShadowTables& keep(const std::vector<Light>& lights, Make&& make) {
        tables_.reset();
        ShadowTables tables = make();
        lights_ = lights;
        return tables_.emplace(std::move(tables));
    }

  private:
    std::vector<Light> lights_;
    std::optional<ShadowTables> tables_;
};

}  // namespace nuvo
