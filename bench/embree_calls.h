#pragma once

#include <embree3/rtcore.h>
#include <immintrin.h>

// Embree's calls by the number of rays, and the state of the processor that they want.

namespace nuvo::bench {

/// What Embree's manual asks of a thread that traces; put back afterwards.
class FlushDenormals {
  public:
    FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | kFlushAndZero); }
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;
    ~FlushDenormals() { _mm_setcsr(before_); }

  private:
    static constexpr unsigned kFlushAndZero = 0x8040;
    unsigned before_;
};

inline RTCIntersectContext context_for(bool coherent) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags =
        coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}

template <int N>
void intersect(const int* valid, RTCScene scene, RTCIntersectContext& context,
               RTCRayHitNt<N>& pack) {
    if constexpr (N == 1) rtcIntersect1(scene, &context, reinterpret_cast<RTCRayHit*>(&pack));
    if constexpr (N == 4)
        rtcIntersect4(valid, scene, &context, reinterpret_cast<RTCRayHit4*>(&pack));
    if constexpr (N == 8)
        rtcIntersect8(valid, scene, &context, reinterpret_cast<RTCRayHit8*>(&pack));
    if constexpr (N == 16)
        rtcIntersect16(valid, scene, &context, reinterpret_cast<RTCRayHit16*>(&pack));
}

template <int N>
void occluded(const int* valid, RTCScene scene, RTCIntersectContext& context, RTCRayNt<N>& pack) {
    if constexpr (N == 1) rtcOccluded1(scene, &context, reinterpret_cast<RTCRay*>(&pack));
    if constexpr (N == 4) rtcOccluded4(valid, scene, &context, reinterpret_cast<RTCRay4*>(&pack));
    if constexpr (N == 8) rtcOccluded8(valid, scene, &context, reinterpret_cast<RTCRay8*>(&pack));
    if constexpr (N == 16)
        rtcOccluded16(valid, scene, &context, reinterpret_cast<RTCRay16*>(&pack));
}

}  // namespace nuvo::bench
