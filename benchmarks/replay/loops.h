// Bare loops over recorded rays: nothing but the intersector and the copying of rays that it asks for.
#pragma once

#include <span>

#include "engine/embree_shim.h"
#include "replay/recording.h"

namespace accuray::bench {

struct Tally {
  uint64_t hits = 0, blocked = 0;
  Tally& operator+=(const Tally& other) {
    hits += other.hits;
    blocked += other.blocked;
    return *this;
  }
};

// Rays of one kind, transposed as Embree wants them.
template <uint32_t Width>
struct Packet {
  float origin[3][Width];
  float direction[3][Width];
  float far[Width];
  uint32_t shadow;
  uint32_t rays;  // lanes in use, from the first
};

// Packets in the order in which a renderer with one queue for each kind would send them.
template <uint32_t Width>
std::vector<Packet<Width>> pack(std::span<const RecordedRay> rays);

// The rays of a chunk by kind, octant of the direction, and Morton code of the origin in the chunk's bounds.
Chunk sorted(const Chunk& chunk);

// By AccuRay's own intersector, which need not be Embree; the other loops are Embree's.
Tally trace_own(const EmbreeAccel& accel, std::span<const RecordedRay> rays);
Tally trace_single(RTCScene scene, std::span<const RecordedRay> rays);
template <uint32_t Width>
Tally trace_packets(RTCScene scene, std::span<const Packet<Width>> packets);

// Rays whose answer now differs in any bit from the recorded one.
uint64_t count_mismatches(const EmbreeAccel& accel, std::span<const RecordedRay> rays);

}  // namespace accuray::bench
