#include "nuvo/scene/defaults.h"

namespace nuvo::x3d {

Defaults standard_defaults() { return {}; }

Defaults thesis_defaults() {
    Defaults defaults;
    defaults.field_of_view_rad = 0.9;
    defaults.light_ambient_intensity = 0.2;
    defaults.beam_width_rad = 1.57079632;
    defaults.cut_off_angle_rad = 0.78539816;
    defaults.specular_color = {1, 1, 1};
    defaults.has_material_ambient = false;
    defaults.has_light_radius = false;
    defaults.smooths_unasked = false;
    defaults.drops_repeats = false;
    return defaults;
}

}  // namespace nuvo::x3d
