// Bisection of increasing numbers.
#pragma once

#include "kernels/port.h"

namespace accuray {

// The interval that x lies in, of the `count` between count + 1 numbers that do not decrease; one of the outermost if
// it lies beyond them. Of equal numbers the last begins it, so an empty interval holds nothing.
// The search may begin between intervals `low` and `high` if the answer is known to lie from low to high - 1.
inline uint32_t interval_between(const float* numbers, uint32_t low, uint32_t high, float x) {
  while (high - low > 1) {
    const uint32_t middle = (low + high) / 2;
    if (numbers[middle] <= x) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return low;
}
inline uint32_t interval_of(const float* numbers, uint32_t count, float x) {
  return interval_between(numbers, 0, count, x);
}

// The same for x in [0, 1) by a guide (Chen and Asau 1974): the intervals that k / parts lie in, k = 0 ... parts, of a
// power of two of parts, so that the products are exact and so is the answer.
inline uint32_t guided_interval_of(const float* numbers, const uint32_t* guide, uint32_t parts, float x) {
  const uint32_t part = static_cast<uint32_t>(x * static_cast<float>(parts));
  return interval_between(numbers, guide[part], guide[part + 1] + 1, x);
}

}  // namespace accuray
