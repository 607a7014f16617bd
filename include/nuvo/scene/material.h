#pragma once

#include "nuvo/math/vec.h"

namespace nuvo {

/// X3D Material (ISO/IEC 19775-1 clause 12), its fields in [0, 1] and its defaults.
struct Material {
    Color diffuse_color{0.8, 0.8, 0.8};
    double ambient_intensity = 0.2;
    Color specular_color{0, 0, 0};
    double shininess = 0.2;  ///< the specular exponent is 128 times this [eq. 44]
    Color emissive_color{0, 0, 0};
    bool lit = true;  ///< false: the colour is emissive_color whatever the lights

    friend bool operator==(const Material&, const Material&) = default;
};

}  // namespace nuvo
