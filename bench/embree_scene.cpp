#include "embree_scene.h"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>

// Embree as its manual says to use it: buffers shared instead of copied, one geometry for all
// triangles, so that there is one hierarchy without instances. [Wald et al., Embree: a kernel
// framework for efficient CPU ray tracing, 2014]

namespace nuvo::bench {

struct EmbreeScene::Meter {
    std::atomic<std::ptrdiff_t> bytes{0};
    std::atomic<std::ptrdiff_t> peak{0};

    static bool count(void* self, ssize_t more, bool) {
        auto* meter = static_cast<Meter*>(self);
        const std::ptrdiff_t now = meter->bytes.fetch_add(more) + more;
        std::ptrdiff_t peak = meter->peak.load();
        while (peak < now && !meter->peak.compare_exchange_weak(peak, now)) {
        }
        return true;
    }
};

namespace {

void throw_embree_error(void*, RTCError, const char* text) {
    throw std::runtime_error(std::string("Embree: ") + text);
}

/// Lets this thread run on one processor only while it lives.
class OneProcessor {
  public:
    OneProcessor() {
        sched_getaffinity(0, sizeof before_, &before_);
        cpu_set_t one;
        CPU_ZERO(&one);
        CPU_SET(sched_getcpu(), &one);
        sched_setaffinity(0, sizeof one, &one);
    }
    OneProcessor(const OneProcessor&) = delete;
    OneProcessor& operator=(const OneProcessor&) = delete;
    ~OneProcessor() { sched_setaffinity(0, sizeof before_, &before_); }

  private:
    cpu_set_t before_;
};

/// A device that builds with one thread. TBB counts the processors when the first is made. If it
/// saw more, its version 2021.12 would leave a worker spinning beside the frames of later devices,
/// although they have one thread, and halve their speed where it shares a core with them.
/// [github.com/uxlfoundation/oneTBB/issues/1417]
RTCDevice new_device(const std::string& isa) {
    const OneProcessor one;
    const std::string config = isa.empty() ? "threads=1" : "threads=1,isa=" + isa;
    const RTCDevice device = rtcNewDevice(config.c_str());
    if (device == nullptr) throw std::runtime_error("Embree makes no device for " + config);
    return device;
}

}  // namespace

EmbreeScene::EmbreeScene(const FloatScene& scene, const EmbreeOptions& options)
    : floats_(scene), meter_(std::make_unique<Meter>()) {
    device_ = new_device(options.isa);
    rtcSetDeviceErrorFunction(device_, throw_embree_error, nullptr);
    rtcSetDeviceMemoryMonitorFunction(device_, Meter::count, meter_.get());
    scene_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene_, options.quality);
    if (!floats_.triangles.empty()) add_triangles();
    if (!floats_.spheres.empty()) add_spheres(options.spheres);
    rtcCommitScene(scene_);
}

EmbreeScene::~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

EmbreeMemory EmbreeScene::memory() const {
    return {static_cast<std::size_t>(std::max<std::ptrdiff_t>(meter_->bytes, 0)),
            static_cast<std::size_t>(std::max<std::ptrdiff_t>(meter_->peak, 0))};
}

std::string EmbreeScene::version() const {
    const auto part = [&](RTCDeviceProperty property) {
        return std::to_string(rtcGetDeviceProperty(device_, property));
    };
    return part(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + "." + part(RTC_DEVICE_PROPERTY_VERSION_MINOR) +
           "." + part(RTC_DEVICE_PROPERTY_VERSION_PATCH);
}

void EmbreeScene::add_triangles() {
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               floats_.positions.data(), 0, sizeof(Float3),
                               floats_.positions.size() - 1);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               floats_.triangles.data(), 0, sizeof(IndexTriple),
                               floats_.triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
}

void EmbreeScene::add_spheres(SphereKind kind) {
    const bool own = kind == SphereKind::kUser;
    const RTCGeometry geometry =
        rtcNewGeometry(device_, own ? RTC_GEOMETRY_TYPE_USER : RTC_GEOMETRY_TYPE_SPHERE_POINT);
    if (own) {
        rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(floats_.spheres.size()));
        use_sphere_callbacks(geometry, floats_);
    } else {
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                   floats_.spheres.data(), 0, sizeof(floats_.spheres[0]),
                                   floats_.spheres.size());
    }
    rtcCommitGeometry(geometry);
    sphere_geometry_ = rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
}

}  // namespace nuvo::bench
