#include <algorithm>
#include <cmath>

#include "reference.h"

namespace nuvo::hard {
namespace {

using Long = Vec3<long double>;

// I_spot [ISO/IEC 19775-1 17.2.2.4]; `from_light` is a unit vector.
long double spot(const Light& light, const Long& from_light) {
    const Long axis(light.direction);
    const long double angle = std::atan2(length(cross(axis, from_light)), dot(axis, from_light));
    const long double cut_off = light.cut_off_angle;
    const long double beam = light.beam_width;
    if (angle >= cut_off) return 0;
    return angle <= beam ? 1 : (angle - cut_off) / (beam - cut_off);
}

}  // namespace

// One sky and one ground colour blend [eq. 36]; these pictures have no other background.
Vec3<long double> Reference::background(const Vec3<long double>& direction) const {
    const Background& colors = scene_.background;
    const Long sky(colors.sky_color[0]);
    if (colors.ground_color.empty()) return sky;
    return sky * ((direction.y + 1) / 2) + Long(colors.ground_color[0]) * ((1 - direction.y) / 2);
}

Vec3<long double> Reference::emitted(const Meeting& meeting) const {
    const Material& material = scene_.materials[scene_.objects[meeting.object].material];
    if (!material.lit && meeting.color) return *meeting.color;
    return Long(material.emissive_color);
}

// attenuation x spot x colour x (ambient + diffuse + specular); none: no light arrives.
std::optional<Vec3<long double>> Reference::light(const Light& light, const Meeting& meeting,
                                                  const Vec3<long double>& to_viewer) const {
    Long to_light = -Long(light.direction);
    long double factor = 1;
    if (light.kind != Light::Kind::kDirectional) {
        const DigitsVector way = DigitsVector(light.location) - meeting.point;
        const Digits distance = sqrt(dot(way, way));
        if (distance == 0 || distance > light.radius) return std::nullopt;
        const DigitsVector toward = way / distance;
        to_light = {static_cast<long double>(toward.x), static_cast<long double>(toward.y),
                    static_cast<long double>(toward.z)};
        const long double d = static_cast<long double>(distance) * light.units_per_world;
        const Long c(light.attenuation);
        factor = 1 / std::max(c.x + c.y * d + c.z * d * d, 1.0L);
    }
    if (light.kind == Light::Kind::kSpot) factor *= spot(light, -to_light);
    if (!(factor > 0)) return std::nullopt;

    const Material& material = scene_.materials[scene_.objects[meeting.object].material];
    const Long& n = meeting.shading;
    const long double intensity = light.intensity;
    const long double ambient =
        static_cast<long double>(light.ambient_intensity) * material.ambient_intensity;
    const long double diffuse = intensity * std::max(0.0L, dot(n, to_light));
    const Long halfway = to_light + to_viewer;
    const long double size = length(halfway);
    const long double cosine = size > 0 ? std::max(0.0L, dot(n, halfway) / size) : 0;
    const long double specular =
        intensity * std::pow(cosine, 128 * static_cast<long double>(material.shininess));
    const Long matt = meeting.color ? *meeting.color : Long(material.diffuse_color);
    const Long reflected = matt * (ambient + diffuse) + Long(material.specular_color) * specular;
    return Long(light.color) * reflected * factor;
}

}  // namespace nuvo::hard
