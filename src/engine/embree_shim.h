// The one file that knows which Embree is there: 3.13 (Debian 12) or 4.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace accuray::embree {

#if RTC_VERSION_MAJOR >= 4

inline void intersect(RTCScene scene, RTCRayHit* ray_hit) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  rtcIntersect1(scene, ray_hit, &arguments);
}
inline void occluded(RTCScene scene, RTCRay* ray) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  rtcOccluded1(scene, ray, &arguments);
}
inline void set_instance(RTCHit& hit, const RTCRayQueryContext* context) { hit.instID[0] = context->instID[0]; }

#else

inline void intersect(RTCScene scene, RTCRayHit* ray_hit) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, ray_hit);
}
inline void occluded(RTCScene scene, RTCRay* ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, ray);
}
inline void set_instance(RTCHit& hit, const RTCIntersectContext* context) { hit.instID[0] = context->instID[0]; }

#endif

// Two things are the same in both but must be said: masks (version 4 changed the default) and the invalid ids.
inline void prepare(RTCRayHit& ray_hit) {
  ray_hit.ray.tnear = 0.0f;
  ray_hit.ray.mask = 0xffffffffu;
  ray_hit.ray.id = 0;
  ray_hit.ray.flags = 0;
  ray_hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray_hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}

}  // namespace accuray::embree
