// Axis-aligned boxes around shapes, for the size of the scene.
#pragma once

#include <algorithm>

#include "kernels/math/constants.h"
#include "kernels/math/vec.h"
#include "lower/transform.h"

namespace accuray {

struct Bounds {
  Vec3 low{infinity, infinity, infinity};
  Vec3 high{-infinity, -infinity, -infinity};

  bool empty() const { return !(low.x <= high.x); }
  void grow(Vec3 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  void grow(const Bounds& other) {
    if (other.empty()) return;
    grow(other.low);
    grow(other.high);
  }
  // A box around the moved box: its corners suffice.
  Bounds moved(const Matrix& m) const {
    Bounds result;
    if (empty()) return result;
    for (unsigned corner = 0; corner < 8; ++corner) {
      const Vec3 p = {(corner & 1u) != 0 ? high.x : low.x, (corner & 2u) != 0 ? high.y : low.y,
                      (corner & 4u) != 0 ? high.z : low.z};
      const auto q = transform_point(m, {p.x, p.y, p.z});
      result.grow(Vec3{static_cast<float>(q[0]), static_cast<float>(q[1]), static_cast<float>(q[2])});
    }
    return result;
  }
};

}  // namespace accuray
