#include "replay/loops.h"

#include <algorithm>
#include <type_traits>

#include "kernels/math/vec.h"

namespace accuray::bench {

namespace {

Ray ray_of(const RecordedRay& ray) {
  return {
      {ray.origin[0], ray.origin[1], ray.origin[2]}, {ray.direction[0], ray.direction[1], ray.direction[2]}, ray.far};
}

void load(RTCRay& target, const RecordedRay& ray) {
  target.org_x = ray.origin[0];
  target.org_y = ray.origin[1];
  target.org_z = ray.origin[2];
  target.tnear = 0.0f;
  target.dir_x = ray.direction[0];
  target.dir_y = ray.direction[1];
  target.dir_z = ray.direction[2];
  target.time = 0.0f;
  target.tfar = ray.far;
  target.mask = 0xffffffffu;
  target.id = 0;
  target.flags = 0;
}

bool is_blocked(RTCScene scene, const RecordedRay& ray) {
  alignas(16) RTCRay r;
  load(r, ray);
  embree::occluded(scene, &r);
  return r.tfar < 0.0f;
}

bool meets(RTCScene scene, const RecordedRay& ray) {
  alignas(16) RTCRayHit rh;
  load(rh.ray, ray);
  rh.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rh.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  embree::intersect(scene, &rh);
  return rh.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

template <uint32_t Width>
struct Embree;
template <>
struct Embree<8> {
  using Rays = RTCRay8;
  using RayHits = RTCRayHit8;
#if RTC_VERSION_MAJOR >= 4
  static void intersect(const int* valid, RTCScene scene, RayHits* rays) { rtcIntersect8(valid, scene, rays, nullptr); }
  static void occluded(const int* valid, RTCScene scene, Rays* rays) { rtcOccluded8(valid, scene, rays, nullptr); }
#else
  static void intersect(const int* valid, RTCScene scene, RayHits* rays) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect8(valid, scene, &context, rays);
  }
  static void occluded(const int* valid, RTCScene scene, Rays* rays) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded8(valid, scene, &context, rays);
  }
#endif
};
template <>
struct Embree<16> {
  using Rays = RTCRay16;
  using RayHits = RTCRayHit16;
#if RTC_VERSION_MAJOR >= 4
  static void intersect(const int* valid, RTCScene scene, RayHits* rays) {
    rtcIntersect16(valid, scene, rays, nullptr);
  }
  static void occluded(const int* valid, RTCScene scene, Rays* rays) { rtcOccluded16(valid, scene, rays, nullptr); }
#else
  static void intersect(const int* valid, RTCScene scene, RayHits* rays) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect16(valid, scene, &context, rays);
  }
  static void occluded(const int* valid, RTCScene scene, Rays* rays) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded16(valid, scene, &context, rays);
  }
#endif
};

template <uint32_t Width>
void load(typename Embree<Width>::Rays& target, const Packet<Width>& packet) {
  std::copy_n(packet.origin[0], Width, target.org_x);
  std::copy_n(packet.origin[1], Width, target.org_y);
  std::copy_n(packet.origin[2], Width, target.org_z);
  std::copy_n(packet.direction[0], Width, target.dir_x);
  std::copy_n(packet.direction[1], Width, target.dir_y);
  std::copy_n(packet.direction[2], Width, target.dir_z);
  std::copy_n(packet.far, Width, target.tfar);
  std::fill_n(target.tnear, Width, 0.0f);
  std::fill_n(target.time, Width, 0.0f);
  std::fill_n(target.mask, Width, 0xffffffffu);
  std::fill_n(target.id, Width, 0u);
  std::fill_n(target.flags, Width, 0u);
}

template <uint32_t Width>
void put(Packet<Width>& packet, uint32_t lane, const RecordedRay& ray) {
  for (uint32_t axis = 0; axis < 3; ++axis) {
    packet.origin[axis][lane] = ray.origin[axis];
    packet.direction[axis][lane] = ray.direction[axis];
  }
  packet.far[lane] = ray.far;
}

// Every third bit from bit 0 on: x must be below 2^10.
uint32_t spread_bits(uint32_t x) {
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  return (x | x << 2) & 0x09249249u;
}

struct Bounds {
  float low[3] = {infinity, infinity, infinity};
  float high[3] = {-infinity, -infinity, -infinity};

  explicit Bounds(const Chunk& chunk) {
    for (const RecordedRay& ray : chunk) {
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = min(low[axis], ray.origin[axis]);
        high[axis] = max(high[axis], ray.origin[axis]);
      }
    }
  }
  uint32_t morton(const RecordedRay& ray) const {
    uint32_t code = 0;
    for (uint32_t axis = 0; axis < 3; ++axis) {
      const float extent = max(high[axis] - low[axis], 1e-30f);
      const float place = clamp((ray.origin[axis] - low[axis]) / extent * 1024.0f, 0.0f, 1023.0f);
      code |= spread_bits(static_cast<uint32_t>(place)) << axis;
    }
    return code;
  }
};

}  // namespace

Tally trace_single(RTCScene scene, std::span<const RecordedRay> rays) {
  Tally tally;
  for (const RecordedRay& ray : rays) {
    if (ray.shadow) {
      tally.blocked += is_blocked(scene, ray) ? 1 : 0;
    } else {
      tally.hits += meets(scene, ray) ? 1 : 0;
    }
  }
  return tally;
}

Tally trace_own(const EmbreeAccel& accel, std::span<const RecordedRay> rays) {
  Tally tally;
  for (const RecordedRay& ray : rays) {
    if (ray.shadow) {
      tally.blocked += accel.transmittance(ray_of(ray)) == 0.0f ? 1 : 0;
    } else {
      tally.hits += accel.closest(ray_of(ray)).geometry != none ? 1 : 0;
    }
  }
  return tally;
}

uint64_t count_mismatches(const EmbreeAccel& accel, std::span<const RecordedRay> rays) {
  uint64_t mismatches = 0;
  for (const RecordedRay& ray : rays) {
    const uint32_t answer =
        ray.shadow ? answer_of(accel.transmittance(ray_of(ray))) : answer_of(accel.closest(ray_of(ray)));
    mismatches += answer != ray.answer ? 1 : 0;
  }
  return mismatches;
}

template <uint32_t Width>
std::vector<Packet<Width>> pack(std::span<const RecordedRay> rays) {
  std::vector<Packet<Width>> packets;
  packets.reserve(rays.size() / Width + 2);
  Packet<Width> open[2] = {};
  open[1].shadow = 1;
  for (const RecordedRay& ray : rays) {
    Packet<Width>& packet = open[ray.shadow];
    put(packet, packet.rays++, ray);
    if (packet.rays < Width) continue;
    packets.push_back(packet);
    packet.rays = 0;
  }
  for (Packet<Width>& packet : open) {
    if (packet.rays != 0) packets.push_back(packet);
  }
  return packets;
}

template <uint32_t Width>
Tally trace_packets(RTCScene scene, std::span<const Packet<Width>> packets) {
  Tally tally;
  alignas(64) typename Embree<Width>::RayHits rh;
  alignas(64) typename Embree<Width>::Rays shadows;
  alignas(64) int valid[Width];
  for (const Packet<Width>& packet : packets) {
    for (uint32_t lane = 0; lane < Width; ++lane) valid[lane] = lane < packet.rays ? -1 : 0;
    if (packet.shadow) {
      load<Width>(shadows, packet);
      Embree<Width>::occluded(valid, scene, &shadows);
      for (uint32_t lane = 0; lane < packet.rays; ++lane) tally.blocked += shadows.tfar[lane] < 0.0f ? 1 : 0;
    } else {
      load<Width>(rh.ray, packet);
      std::fill_n(rh.hit.geomID, Width, RTC_INVALID_GEOMETRY_ID);
      std::fill_n(rh.hit.instID[0], Width, RTC_INVALID_GEOMETRY_ID);
      Embree<Width>::intersect(valid, scene, &rh);
      for (uint32_t lane = 0; lane < packet.rays; ++lane) {
        tally.hits += rh.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
      }
    }
  }
  return tally;
}

Chunk sorted(const Chunk& chunk) {
  const Bounds bounds(chunk);
  std::vector<std::pair<uint64_t, uint32_t>> order;
  order.reserve(chunk.size());
  for (uint32_t i = 0; i < chunk.size(); ++i) {
    const RecordedRay& ray = chunk[i];
    uint64_t octant = ray.shadow;
    for (const float d : ray.direction) octant = 2 * octant + (d < 0.0f ? 1 : 0);
    order.emplace_back(octant << 30 | bounds.morton(ray), i);
  }
  std::sort(order.begin(), order.end());
  Chunk result;
  result.reserve(chunk.size());
  for (const auto& [key, i] : order) result.push_back(chunk[i]);
  return result;
}

template std::vector<Packet<8>> pack<8>(std::span<const RecordedRay>);
template std::vector<Packet<16>> pack<16>(std::span<const RecordedRay>);
template Tally trace_packets<8>(RTCScene, std::span<const Packet<8>>);
template Tally trace_packets<16>(RTCScene, std::span<const Packet<16>>);

}  // namespace accuray::bench
