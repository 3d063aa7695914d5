// Cosine and sine of a share of a full turn, with the same bits on every machine.
#pragma once

#include <cstdint>

namespace accuray::mesh {

struct Turn {
  double cos, sin;
};

// Of k / n of a turn, for n of at least 1. The quadrant is removed exactly; Taylor's series over an eighth of a turn.
inline Turn turn(uint64_t k, uint64_t n) {
  uint64_t quadrant = (8 * (k % n) + n) / (2 * n);
  int64_t rest = static_cast<int64_t>(4 * (k % n)) - static_cast<int64_t>(quadrant * n);
  double x = 0x1.921fb54442d18p+0 * static_cast<double>(rest) / static_cast<double>(n);
  double y = x * x;
  double cosine = 0.0, sine = 0.0;
  for (int i = 10; i > 0; --i) {
    cosine = (1.0 + cosine) * -y / ((2.0 * i - 1.0) * (2.0 * i));
    sine = (1.0 + sine) * -y / ((2.0 * i) * (2.0 * i + 1.0));
  }
  Turn r = {1.0 + cosine, x + x * sine};
  switch (quadrant % 4) {
    case 0:
      return r;
    case 1:
      return {-r.sin, r.cos};
    case 2:
      return {-r.cos, -r.sin};
    default:
      return {r.sin, -r.cos};
  }
}

}  // namespace accuray::mesh
