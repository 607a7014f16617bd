#include <cmath>

#include "embree_scene.h"

// Spheres as user geometry. Each callback is one loop over the packet's lanes without a branch, so
// that the compiler makes it vector code (this file is compiled for the machine it runs on). The
// perpendicular form r^2 - |f - (f.d) d|^2 keeps its digits far away. [Haines et al., Precision
// improvements for ray/sphere intersection, Ray Tracing Gems, 2019]

namespace nuvo::bench {
namespace {

/// The first root in (tnear, tfar), for a unit direction; `hit` says whether there is one.
struct SphereRootFloat {
    float t;
    bool hit;
};

template <typename RayPack>
inline SphereRootFloat root(const RayPack& ray, unsigned i, const std::array<float, 4>& sphere) {
    const float fx = sphere[0] - ray.org_x[i];
    const float fy = sphere[1] - ray.org_y[i];
    const float fz = sphere[2] - ray.org_z[i];
    const float dx = ray.dir_x[i];
    const float dy = ray.dir_y[i];
    const float dz = ray.dir_z[i];
    const float along = fx * dx + fy * dy + fz * dz;
    const float lx = fx - along * dx;
    const float ly = fy - along * dy;
    const float lz = fz - along * dz;
    const float depth = sphere[3] * sphere[3] - (lx * lx + ly * ly + lz * lz);
    const float half = std::sqrt(depth > 0 ? depth : 0);
    const float first = along - half;
    const float t = first > ray.tnear[i] ? first : along + half;
    return {t, ((depth >= 0) & (t > ray.tnear[i]) & (t < ray.tfar[i])) != 0};
}

template <unsigned N>
void intersect(const RTCIntersectFunctionNArguments& arguments) {
    auto& pack = *reinterpret_cast<RTCRayHitNt<N>*>(arguments.rayhit);
    const auto& scene = *static_cast<const FloatScene*>(arguments.geometryUserPtr);
    const std::array<float, 4> sphere = scene.spheres[arguments.primID];
    const int* const valid = arguments.valid;
    const unsigned primitive = arguments.primID;
    const unsigned geometry = arguments.geomID;
#pragma GCC ivdep
    for (unsigned i = 0; i < N; ++i) {
        const SphereRootFloat found = root(pack.ray, i, sphere);
        const bool hit = (found.hit & (valid[i] != 0)) != 0;
        pack.ray.tfar[i] = hit ? found.t : pack.ray.tfar[i];
        pack.hit.primID[i] = hit ? primitive : pack.hit.primID[i];
        pack.hit.geomID[i] = hit ? geometry : pack.hit.geomID[i];
    }
}

template <unsigned N>
void occluded(const RTCOccludedFunctionNArguments& arguments) {
    auto& pack = *reinterpret_cast<RTCRayNt<N>*>(arguments.ray);
    const auto& scene = *static_cast<const FloatScene*>(arguments.geometryUserPtr);
    const std::array<float, 4> sphere = scene.spheres[arguments.primID];
    const int* const valid = arguments.valid;
#pragma GCC ivdep
    for (unsigned i = 0; i < N; ++i) {
        const bool hit = (root(pack, i, sphere).hit & (valid[i] != 0)) != 0;
        pack.tfar[i] = hit ? -INFINITY : pack.tfar[i];
    }
}

void intersect_any(const RTCIntersectFunctionNArguments* arguments) {
    switch (arguments->N) {
        case 1:
            return intersect<1>(*arguments);
        case 4:
            return intersect<4>(*arguments);
        case 8:
            return intersect<8>(*arguments);
        case 16:
            return intersect<16>(*arguments);
        default:
            break;
    }
}

void occluded_any(const RTCOccludedFunctionNArguments* arguments) {
    switch (arguments->N) {
        case 1:
            return occluded<1>(*arguments);
        case 4:
            return occluded<4>(*arguments);
        case 8:
            return occluded<8>(*arguments);
        case 16:
            return occluded<16>(*arguments);
        default:
            break;
    }
}

void bounds(const RTCBoundsFunctionArguments* arguments) {
    const auto& scene = *static_cast<const FloatScene*>(arguments->geometryUserPtr);
    const std::array<float, 4>& s = scene.spheres[arguments->primID];
    RTCBounds& box = *arguments->bounds_o;
    box.lower_x = s[0] - s[3];
    box.lower_y = s[1] - s[3];
    box.lower_z = s[2] - s[3];
    box.upper_x = s[0] + s[3];
    box.upper_y = s[1] + s[3];
    box.upper_z = s[2] + s[3];
}

}  // namespace

void use_sphere_callbacks(RTCGeometry geometry, const FloatScene& scene) {
    // Embree wants a pointer to something it may change; the callbacks only read.
    rtcSetGeometryUserData(geometry, const_cast<FloatScene*>(&scene));
    rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_any);
    rtcSetGeometryOccludedFunction(geometry, occluded_any);
}

}  // namespace nuvo::bench
