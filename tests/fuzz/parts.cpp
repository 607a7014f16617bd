#include "parts.h"

#include <cmath>

#include "nuvo/math/affine.h"

namespace nuvo::fuzz {
namespace {

Element appearance(Chooser& choose) {
    Element material{"Material", {}, {}};
    if (choose.once_in(2)) material.set("diffuseColor", choose.color());
    if (choose.once_in(3)) material.set("specularColor", choose.color());
    if (choose.once_in(3)) material.set("shininess", text(choose.fraction()));
    if (choose.once_in(5)) material.set("ambientIntensity", text(choose.fraction()));
    if (choose.once_in(8)) material.set("emissiveColor", choose.color());
    if (choose.once_in(16)) material.set("transparency", text(choose.fraction()));
    Element appearance{"Appearance", {}, {}};
    if (!choose.once_in(20)) appearance.add(std::move(material));
    return appearance;
}

// A rotation about an axis, a diagonal or anything; small, right-angled or any angle.
std::string any_rotation(Chooser& choose) {
    constexpr double kAngles[] = {
        1.5707963267948966, 3.1415926535897931, 0.7853981633974483, 1e-3, 1e-9, 1e-16};
    const double angle = choose.once_in(2) ? choose.one_of(kAngles) : choose.uniform(-3.2, 3.2);
    return text(choose.direction()) + " " + text(angle);
}

Vector3 any_scale(Chooser& choose) {
    const double size = choose.once_in(2) ? 1 : choose.size();
    Vector3 scale{size, size, size};
    switch (choose.below(6)) {
        case 0:  // flat or thin
        case 1: {
            constexpr double kFlat[] = {0.5, 0.1, 0.01, 1e-3, 1e-6, 1e-12, 1e-20, 4, 30};
            scale[choose.below(3)] *= choose.one_of(kFlat);
            if (choose.once_in(3)) scale[choose.below(3)] *= choose.one_of(kFlat);
            break;
        }
        case 2:
            scale = {choose.uniform(0.2, 3), choose.uniform(0.2, 3), choose.uniform(0.2, 3)};
            break;
        case 3:
            if (choose.numbers == Numbers::kExtreme) scale[choose.below(3)] *= choose.magnitude();
            break;
        default:
            break;
    }
    if (choose.once_in(8)) scale[choose.below(3)] *= -1;
    if (choose.once_in(80)) scale[choose.below(3)] = 0;
    return scale;
}

}  // namespace

Element shape_of(Chooser& choose, Element geometry) {
    Element shape{"Shape", {}, {}};
    if (!choose.once_in(12)) shape.add(appearance(choose));
    return shape.add(std::move(geometry));
}

Element sphere(Chooser& choose) {
    Element sphere{"Sphere", {}, {}};
    if (choose.once_in(2)) sphere.set("radius", text(choose.size()));
    if (choose.once_in(4)) sphere.set("solid", "false");
    return sphere;
}

Element scaled(Element child, const Vector3& factors) {
    Element transform{"Transform", {{"scale", text(factors)}}, {}};
    return transform.add(std::move(child));
}

Element moved(Element child, const Vector3& by) {
    Element transform{"Transform", {{"translation", text(by)}}, {}};
    return transform.add(std::move(child));
}

Element transformed(Chooser& choose, Element child) {
    Element transform{"Transform", {}, {}};
    if (!choose.once_in(4)) transform.set("translation", text(choose.point(4)));
    if (choose.once_in(3)) transform.set("rotation", any_rotation(choose));
    if (choose.once_in(2)) transform.set("scale", text(any_scale(choose)));
    if (choose.once_in(8)) transform.set("scaleOrientation", any_rotation(choose));
    if (choose.once_in(12)) transform.set("center", text(choose.point(2)));
    return transform.add(std::move(child));
}

Element any_light(Chooser& choose, const Point3& place) {
    constexpr const char* kKinds[] = {"DirectionalLight", "PointLight", "PointLight", "SpotLight"};
    Element light{choose.one_of(kKinds), {}, {}};
    const bool stands = light.name != "DirectionalLight";
    if (stands) light.set("location", text(place));
    if (light.name != "PointLight") light.set("direction", text(choose.direction()));
    if (light.name == "SpotLight") {
        constexpr double kAngles[] = {1.570796, 0.785398, 0.3, 0.1, 1e-3, 2e-7, 1e-60};
        if (choose.once_in(2)) light.set("cutOffAngle", text(choose.one_of(kAngles)));
        if (choose.once_in(2)) light.set("beamWidth", text(choose.one_of(kAngles)));
    }
    if (stands && choose.once_in(4)) {
        constexpr const char* kAttenuations[] = {
            "0 0 0", "1 0.1 0", "0 0 1", "1e-300 0 0", "0 1e300 0", "0.5 0.1 0.02", "0 0 1e-300"};
        light.set("attenuation", choose.one_of(kAttenuations));
    }
    if (stands && choose.once_in(3)) {
        constexpr const char* kRadii[] = {"1e300", "1000", "4", "1", "0.01", "0", "1e-300"};
        light.set("radius", choose.one_of(kRadii));
    }
    if (choose.once_in(3)) light.set("intensity", text(choose.fraction()));
    if (choose.once_in(4)) light.set("ambientIntensity", text(choose.fraction()));
    if (choose.once_in(4)) light.set("color", choose.color());
    if (choose.once_in(4)) light.set("global", choose.once_in(2) ? "true" : "false");
    if (choose.once_in(30)) light.set("on", "false");
    return light;
}

Element viewpoint(Chooser& choose, const Point3& place, const Point3& target) {
    Element view{"Viewpoint", {{"position", text(place)}}, {}};
    Vector3 d = normalized(target - place);
    if (d == Vector3{} || choose.once_in(5)) d = normalized(choose.direction());
    // The rotation that takes (0, 0, -1) to d.
    Vector3 axis = cross({0, 0, -1}, d);
    const double angle = std::atan2(length(axis), -d.z);
    if (axis == Vector3{}) axis = {0, 1, 0};
    view.set("orientation", text(axis) + " " + text(angle));
    if (choose.once_in(4)) {
        constexpr double kHalves[] = {4, 2, 1, 12, 0.01, 1e-6, 1e-12, 1e7};
        const double half = choose.one_of(kHalves);
        const double low = choose.once_in(3) ? -half * choose.fraction() : -half;
        view.name = "OrthoViewpoint";
        view.set("fieldOfView",
                 text(low) + " " + text(-half) + " " + text(half) + " " + text(half));
        return view;
    }
    constexpr double kAngles[] = {1.2, 0.3, 1.5, 2.5, 3.1, 0.01, 1e-6, 1e-12};
    if (choose.once_in(3)) view.set("fieldOfView", text(choose.one_of(kAngles)));
    return view;
}

Point3 hard_point(Chooser& choose) {
    constexpr double kPlaces[] = {0, 0, 1, -1, 0.5, 2, 1.5};
    Point3 p{choose.one_of(kPlaces), choose.one_of(kPlaces), choose.one_of(kPlaces)};
    if (choose.once_in(3)) p = Point3{} + normalized(p);  // on the unit sphere, up to rounding
    if (choose.once_in(4)) {                              // a little off
        constexpr double kOff[] = {1e-3, 1e-6, 1e-9, 1e-15, -1e-15, -1e-6};
        p[choose.below(3)] += choose.one_of(kOff);
    }
    if (choose.once_in(4)) p[choose.below(3)] = choose.nearly(p[0]);
    return p;
}

}  // namespace nuvo::fuzz
