#pragma once

#if NUVO_EMBREE_MAJOR == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <immintrin.h>

// Embree's calls by the number of rays, the same for Embree 3 and 4, and the state of the processor
// that they want. What the two versions do not share is here and nowhere else.

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

#if NUVO_EMBREE_MAJOR == 4

/// What Embree wants to know of rays besides themselves.
struct RayQuery {
    explicit RayQuery(bool coherent) {
        rtcInitIntersectArguments(&nearest);
        rtcInitOccludedArguments(&any);
        nearest.flags = any.flags =
            coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    }
    operator RTCIntersectArguments*() { return &nearest; }
    operator RTCOccludedArguments*() { return &any; }

    RTCIntersectArguments nearest;
    RTCOccludedArguments any;
};

/// One of rtcIntersect1() and rtcOccluded1(), and of their like for packets; `rays` are what it
/// takes, under another name of the same layout.
template <typename Rays, typename Arguments>
void call(void (*embree)(RTCScene, Rays*, Arguments*), const int*, RTCScene scene, RayQuery& query,
          void* rays) {
    embree(scene, static_cast<Rays*>(rays), query);
}
template <typename Rays, typename Arguments>
void call(void (*embree)(const int*, RTCScene, Rays*, Arguments*), const int* valid, RTCScene scene,
          RayQuery& query, void* rays) {
    embree(valid, scene, static_cast<Rays*>(rays), query);
}

#else

/// What Embree wants to know of rays besides themselves.
struct RayQuery {
    explicit RayQuery(bool coherent) {
        rtcInitIntersectContext(&context);
        context.flags =
            coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    }

    RTCIntersectContext context;
};

/// One of rtcIntersect1() and rtcOccluded1(), and of their like for packets; `rays` are what it
/// takes, under another name of the same layout.
template <typename Rays>
void call(void (*embree)(RTCScene, RTCIntersectContext*, Rays*), const int*, RTCScene scene,
          RayQuery& query, void* rays) {
    embree(scene, &query.context, static_cast<Rays*>(rays));
}
template <typename Rays>
void call(void (*embree)(const int*, RTCScene, RTCIntersectContext*, Rays*), const int* valid,
          RTCScene scene, RayQuery& query, void* rays) {
    embree(valid, scene, &query.context, static_cast<Rays*>(rays));
}

#endif

template <int N>
void intersect(const int* valid, RTCScene scene, RayQuery& query, RTCRayHitNt<N>& pack) {
    if constexpr (N == 1) call(rtcIntersect1, valid, scene, query, &pack);
    if constexpr (N == 4) call(rtcIntersect4, valid, scene, query, &pack);
    if constexpr (N == 8) call(rtcIntersect8, valid, scene, query, &pack);
    if constexpr (N == 16) call(rtcIntersect16, valid, scene, query, &pack);
}

template <int N>
void occluded(const int* valid, RTCScene scene, RayQuery& query, RTCRayNt<N>& pack) {
    if constexpr (N == 1) call(rtcOccluded1, valid, scene, query, &pack);
    if constexpr (N == 4) call(rtcOccluded4, valid, scene, query, &pack);
    if constexpr (N == 8) call(rtcOccluded8, valid, scene, query, &pack);
    if constexpr (N == 16) call(rtcOccluded16, valid, scene, query, &pack);
}

}  // namespace nuvo::bench
