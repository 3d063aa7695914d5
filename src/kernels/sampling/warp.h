// Maps from the unit square to directions and surfaces, each with its density.
#pragma once

#include "kernels/math/functions.h"
#include "kernels/math/vec.h"

namespace accuray {

// Unit square to unit disk, area-preserving and continuous (Shirley and Chiu 1997).
inline Vec2 square_to_disk(Vec2 u) {
  const float a = 2.0f * u.x - 1.0f;
  const float b = 2.0f * u.y - 1.0f;
  if (a == 0.0f && b == 0.0f) return {0.0f, 0.0f};
  if (abs(a) > abs(b)) {
    const float phi = quarter_pi * (b / a);
    return {a * cos_quadrant(phi), a * sin_quadrant(phi)};
  }
  const float phi = quarter_pi * (a / b);
  return {b * sin_quadrant(phi), b * cos_quadrant(phi)};
}

// Cosine-weighted hemisphere around +z (Malley's method); density cos(theta) / pi.
inline Vec3 square_to_cosine_hemisphere(Vec2 u) {
  const Vec2 d = square_to_disk(u);
  return {d.x, d.y, sqrt(max(0.0f, 1.0f - d.x * d.x - d.y * d.y))};
}
inline float cosine_hemisphere_pdf(float cos_theta) { return max(cos_theta, 0.0f) * inv_pi; }

// Uniform hemisphere around +z.
inline Vec3 square_to_hemisphere(Vec2 u) {
  const float r = sqrt(max(0.0f, 1.0f - u.x * u.x));
  const SinCos angle = sincos(2.0f * pi * u.y);
  return {r * angle.cos, r * angle.sin, u.x};
}
constexpr float uniform_hemisphere_pdf = 0.5f * inv_pi;

// Uniform sphere; density 1 / (4 pi).
inline Vec3 square_to_sphere(Vec2 u) {
  const float z = 1.0f - 2.0f * u.x;
  const float r = sqrt(max(0.0f, 1.0f - z * z));
  const SinCos angle = sincos(2.0f * pi * u.y);
  return {r * angle.cos, r * angle.sin, z};
}
constexpr float uniform_sphere_pdf = 0.25f * inv_pi;

// Uniform triangle: barycentric coordinates of vertices 1 and 2, by a map of low distortion (Heitz 2019).
inline Vec2 square_to_triangle(Vec2 u) {
  if (u.y > u.x) {
    const float x = 0.5f * u.x;
    return {x, u.y - x};
  }
  const float y = 0.5f * u.y;
  return {u.x - y, y};
}

// Uniform regular polygon with its corners on the unit circle, one of them at the angle `rotation`.
inline Vec2 square_to_polygon(Vec2 u, uint32_t corners, float rotation) {
  const float n = static_cast<float>(corners);
  const float side = min(floor(u.x * n), n - 1.0f);
  const Vec2 b = square_to_triangle({fma(u.x, n, -side), u.y});
  const float step = 2.0f * pi / n;
  const SinCos first = sincos(fma(side, step, rotation));
  const SinCos second = sincos(fma(side + 1.0f, step, rotation));
  return {fma(b.x, first.cos, b.y * second.cos), fma(b.x, first.sin, b.y * second.sin)};
}

}  // namespace accuray
