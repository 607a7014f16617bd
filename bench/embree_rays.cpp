#include <limits>

#include "embree_calls.h"
#include "embree_frame.h"
#include "embree_shading.h"

// Single rays in any order: rtcIntersect1.

namespace nuvo::bench {

std::vector<SingleHit> closest_hits(const EmbreeScene& scene, std::span<const Ray> rays) {
    const FlushDenormals flush;
    RayQuery query(false);
    std::vector<SingleHit> hits;
    hits.reserve(rays.size());
    for (const Ray& ray : rays) {
        const Float3 direction = unit(Float3(ray.direction));
        RTCRayHit one;
        one.ray = {static_cast<float>(ray.origin.x),
                   static_cast<float>(ray.origin.y),
                   static_cast<float>(ray.origin.z),
                   0,
                   direction.x,
                   direction.y,
                   direction.z,
                   0,
                   std::numeric_limits<float>::infinity(),
                   ~0U,
                   0,
                   0};
        one.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        call(rtcIntersect1, nullptr, scene.handle(), query, &one);
        hits.push_back({one.hit.geomID != RTC_INVALID_GEOMETRY_ID,
                        one.hit.geomID == scene.sphere_geometry(), one.hit.primID, one.ray.tfar});
    }
    return hits;
}

}  // namespace nuvo::bench
