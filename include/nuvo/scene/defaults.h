#pragma once

#include <optional>

#include "nuvo/math/vec.h"
#include "nuvo/scene/camera.h"

namespace nuvo::x3d {

/// What stands in for fields that a file leaves out, and how a few that it gives are taken. As
/// made: the X3D standard.
struct Defaults {
    double field_of_view_rad = Camera{}.field_of_view_rad;
    double light_ambient_intensity = 0;
    std::optional<double> beam_width_rad;     ///< none: as the file's version has it
    std::optional<double> cut_off_angle_rad;  ///< likewise
    Color specular_color{0, 0, 0};
    bool has_material_ambient = true;  ///< false: a light's ambient part meets every material whole
    bool has_light_radius = true;      ///< false: lights reach everywhere
    /// False: triangle sets are flat unless they state normalPerVertex, whatever normals they have.
    bool smooths_unasked = true;
    /// False: a shape exactly where an earlier one stands is kept, though it is never seen.
    bool drops_repeats = true;
};

Defaults standard_defaults();
/// Those of the published program. [docs/thesis-map.md, section 7]
Defaults thesis_defaults();

}  // namespace nuvo::x3d
