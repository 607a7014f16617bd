#include "fast/light/light_point.h"

#include <cmath>

namespace nuvo {

LightPoint::LightPoint(const Light& light, const LocalFrame& frame) {
    if (light.kind == Light::Kind::kDirectional) {
        toward = -light.direction;
        return;
    }
    toward = frame.local(light.location);
    weight = 1;
    const double norm = max_norm(toward);
    if (norm > 1) {
        int exponent = 0;
        std::frexp(norm, &exponent);
        weight = std::ldexp(1.0, -exponent);
        toward = toward * weight;
    }
    finite = std::isfinite(norm) && std::isfinite(toward.x + toward.y + toward.z);
}

}  // namespace nuvo
