// The keys of what moves, and the room that it takes on its way.
#pragma once

#include <span>
#include <vector>

#include "kernels/light/light.h"
#include "kernels/scene_view.h"
#include "lower/bounds.h"
#include "lower/parameters.h"

namespace accuray {

// Most keys that Embree takes of one motion.
inline constexpr size_t most_motion_keys = 129;

class MotionPool {
 public:
  // The number of a motion: its transforms at equal steps of time, 2 to most_motion_keys of them, each of which leaves
  // a volume. Throws invalid_argument for others.
  uint32_t add(std::span<const Matrix> keys);

  // A box around a moved box at all times: points move on straight lines between the keys.
  Bounds swept(uint32_t motion, const Bounds& box) const;
  // Bounds of a light at all times; without an axis if it turns.
  LightBounds swept(uint32_t motion, const LightBounds& light) const;
  // Largest factor of areas at the keys, taken alike in all directions.
  double area_factor(uint32_t motion) const;

  const std::vector<MotionRecord>& records() const { return records_; }
  const std::vector<Transform>& keys() const { return keys_; }

 private:
  std::span<const Matrix> matrices_of(uint32_t motion) const;

  std::vector<MotionRecord> records_;
  std::vector<Transform> keys_;
  std::vector<Matrix> matrices_;  // the same keys
};

}  // namespace accuray
