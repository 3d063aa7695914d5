// Rounding-error bounds and ray origins that cannot meet their own surface again: no epsilon anywhere.
#pragma once

#include "kernels/math/vec.h"

namespace accuray {

constexpr float machine_epsilon = 0x1p-24f;

// Bound of the relative error of n roundings in a row (Higham 2002, lemma 3.1).
constexpr float gamma(int n) {
  return (static_cast<float>(n) * machine_epsilon) / (1.0f - static_cast<float>(n) * machine_epsilon);
}

// The neighbour of x away from zero in the direction of `toward`'s sign.
inline float next_after(float x, float toward) {
  if (x == 0.0f) return toward > 0.0f ? 0x1p-149f : -0x1p-149f;
  const uint32_t bits = bits_of(x);
  return float_of((x > 0.0f) == (toward > 0.0f) ? bits + 1u : bits - 1u);
}

// Moves p, known up to +-error per axis, off its surface with unit normal n to the side that `direction` points to:
// far enough that the true surface lies behind (Pharr, Jakob and Humphreys 2023, section 6.8.6).
inline Vec3 offset_origin(Vec3 p, Vec3 error, Vec3 n, Vec3 direction) {
  const float distance = dot(abs(n), error);
  const Vec3 offset = n * (dot(direction, n) < 0.0f ? -distance : distance);
  Vec3 q = p + offset;
  if (offset.x != 0.0f) q.x = next_after(q.x, offset.x);
  if (offset.y != 0.0f) q.y = next_after(q.y, offset.y);
  if (offset.z != 0.0f) q.z = next_after(q.z, offset.z);
  return q;
}

}  // namespace accuray
