// Rounding-error bounds and ray origins that cannot meet their own surface again: no epsilon anywhere.
#pragma once

#include "kernels/math/vec.h"

namespace accuray {

constexpr float machine_epsilon = 0x1p-24f;

// Bound of the relative error of n roundings in a row (Higham 2002, lemma 3.1).
constexpr float gamma(int n) {
  return (static_cast<float>(n) * machine_epsilon) / (1.0f - static_cast<float>(n) * machine_epsilon);
}

// Moves p, known up to +-error per axis, off its surface with unit normal n to the side that `direction` points to:
// far enough that the true surface lies behind (Pharr, Jakob and Humphreys 2023, section 6.8.6). In place of rounding
// each coordinate of the result away from the surface, which takes branches, every bound of `error` holds gamma(2)
// times the coordinates' magnitudes more than the point's own error: the sum's rounding cannot use it up.
inline Vec3 offset_origin(Vec3 p, Vec3 error, Vec3 n, Vec3 direction) {
  const float distance = dot(abs(n), error);
  return fma(dot(direction, n) < 0.0f ? -distance : distance, n, p);
}

}  // namespace accuray
