// The rays that a rendering traces, written down in the order in which one thread meets them.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/pass.h"

namespace accuray::bench {

// Half a cache line: what Embree needs to trace the ray again, and a digest of what it answered.
struct RecordedRay {
  float origin[3];
  float direction[3];
  float far;
  uint32_t shadow : 1;
  uint32_t answer : 31;  // closest: digest of the hit; shadow: whether something is in the way
};
static_assert(sizeof(RecordedRay) == 32);

using Chunk = std::vector<RecordedRay>;

// `answer` of a ray; equal hits, and in practice only those, have equal ones.
constexpr uint32_t nothing_hit = 0;
inline uint32_t answer_of(const Hit& hit) {
  return hit.geometry == none ? nothing_hit : hash(bits_of(hit.t), hit.primitive, hit.geometry) >> 1;
}
inline uint32_t answer_of(float transmittance) { return transmittance == 0.0f ? 1 : 0; }

struct Recording {
  std::vector<Chunk> tiles;  // the rays of each tile of the picture
  uint64_t closest = 0, shadow = 0;
  uint64_t hits = 0, blocked = 0;
  uint64_t film_sum = 0;  // of all samples' quantized values, modulo 2^64

  uint64_t rays() const { return closest + shadow; }
};

// Samples 0 ... spp-1 of every pixel of the picture that `request` describes, rendered as render_tile does.
Recording record(const EmbreeScene& scene, const Request& request, uint32_t spp, uint32_t threads);

// The same number as Recording::film_sum, by the engine itself: renders the picture and measures nothing else.
uint64_t render(const EmbreeScene& scene, const Request& request, uint32_t spp, uint32_t threads);

}  // namespace accuray::bench
