// Integer hashes: every random decision of a sample is a pure function of (seed, pixel, sample, dimension).
#pragma once

#include "kernels/port.h"

namespace accuray {

// 32-bit finaliser with low bias (Wellons 2018, "hash-prospector", lowbias32).
inline uint32_t hash(uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}
inline uint32_t hash(uint32_t a, uint32_t b) { return hash(hash(a) + b * 0x9e3779b9u + 0x7f4a7c15u); }
inline uint32_t hash(uint32_t a, uint32_t b, uint32_t c) { return hash(hash(a, b), c); }
inline uint32_t hash(uint32_t a, uint32_t b, uint32_t c, uint32_t d) { return hash(hash(a, b, c), d); }

// The same finaliser on four lanes.
inline u32x4 hash(u32x4 x) {
  x ^= x >> 16u;
  x *= 0x7feb352du;
  x ^= x >> 15u;
  x *= 0x846ca68bu;
  x ^= x >> 16u;
  return x;
}

// Uniform in [0, 1 - 2^-24] from the upper 24 bits, which a float holds exactly.
inline f32x4 uniform(u32x4 x) { return to_float(x >> 8u) * 0x1p-24f; }
inline float uniform(uint32_t x) { return static_cast<float>(x >> 8) * 0x1p-24f; }

}  // namespace accuray
