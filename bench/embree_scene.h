#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "embree_calls.h"
#include "float_scene.h"

namespace nuvo::bench {

/// How Embree keeps spheres.
enum class SphereKind {
    kUser,   ///< RTC_GEOMETRY_TYPE_USER with callbacks in vectors
    kPoint,  ///< RTC_GEOMETRY_TYPE_SPHERE_POINT
};

/// What is chosen before Embree builds, with one thread.
struct EmbreeOptions {
    std::string isa;  ///< of its device configuration, e.g. "avx2"; empty: the best
    RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM;
    SphereKind spheres = SphereKind::kUser;
};

/// Bytes that Embree holds. The vertices, indices and spheres given to it are not among them.
struct EmbreeMemory {
    std::size_t structure = 0;  ///< after the build
    std::size_t peak = 0;       ///< during the build
};

/// A built Embree scene over the arrays of a FloatScene, which it refers to.
class EmbreeScene {
  public:
    /// Builds. Throws std::runtime_error with Embree's own message.
    EmbreeScene(const FloatScene& scene, const EmbreeOptions& options);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    RTCScene handle() const { return scene_; }
    const FloatScene& floats() const { return floats_; }
    /// The geometry that spheres carry in hits; triangles carry the other.
    unsigned sphere_geometry() const { return sphere_geometry_; }
    EmbreeMemory memory() const;
    /// Of the library that runs, e.g. "3.13.5".
    std::string version() const;

  private:
    struct Meter;

    void add_triangles();
    void add_spheres(SphereKind kind);

    const FloatScene& floats_;
    std::unique_ptr<Meter> meter_;  // at a fixed place: Embree keeps its address
    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
    unsigned sphere_geometry_ = RTC_INVALID_GEOMETRY_ID;
};

/// Gives `geometry` the callbacks of a sphere for single rays and packets of 4, 8 and 16. Ray
/// directions must be unit.
void use_sphere_callbacks(RTCGeometry geometry, const FloatScene& scene);

}  // namespace nuvo::bench
