// Bisection of increasing numbers.
#pragma once

#include "kernels/port.h"

namespace accuray {

// The interval that x lies in, of the `count` between count + 1 numbers that do not decrease; one of the outermost if
// it lies beyond them. Of equal numbers the last begins it, so an empty interval holds nothing.
inline uint32_t interval_of(const float* numbers, uint32_t count, float x) {
  uint32_t low = 0;
  uint32_t high = count;
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

}  // namespace accuray
