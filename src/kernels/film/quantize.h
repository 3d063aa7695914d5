// From a sample's channel values to integers that can be added in any order.
//
// A value is rounded to a multiple of the film's step, up or down with probabilities that make the rounding unbiased.
// The dither is a hash of (key, channel), so it is part of the sample's pure function.
#pragma once

#include "kernels/sampling/hash.h"

namespace accuray {

constexpr uint32_t film_channels = 4;   // X, Y, Z, alpha
constexpr uint32_t layer_channels = 3;  // X, Y, Z of a further layer

struct Quantized {
  int64_t value[film_channels];
  bool finite;  // false: the sample is dropped, counted and reported
};

// Values of more steps than this do not fit a 64-bit integer: they count as not finite.
constexpr double largest_steps = 0x1p62;

inline Quantized quantize(f32x4 channels, float inverse_step, uint32_t key) {
  Quantized q{{0, 0, 0, 0}, true};
  const f32x4 dither = uniform(hash(lanes_u(key) + lanes_u(0x1b873593u, 0x85ebca6bu, 0xc2b2ae35u, 0xe6546b64u)));
  for (uint32_t c = 0; c < film_channels; ++c) {
    // A float times a power of two is exact, and so is adding a dither of 24 bits in double.
    const double steps = static_cast<double>(channels[c]) * static_cast<double>(inverse_step);
    if (!(abs(steps) < largest_steps)) return {{0, 0, 0, 0}, false};
    q.value[c] = static_cast<int64_t>(floor(steps + static_cast<double>(dither[c])));
  }
  return q;
}

// Sum that reports overflow in place of wrapping.
inline bool add_checked(int64_t& sum, int64_t value) {
  const int64_t result = static_cast<int64_t>(static_cast<uint64_t>(sum) + static_cast<uint64_t>(value));
  if (((sum ^ result) & (value ^ result)) < 0) return false;
  sum = result;
  return true;
}

}  // namespace accuray
