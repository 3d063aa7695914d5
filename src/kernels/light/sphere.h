// An emissive sphere: from outside its cone of directions is sampled uniformly, from inside its area.
#pragma once

#include "kernels/light/light.h"

namespace accuray {

struct SphereLight {
  Vec3 center;
  float radius;

  static constexpr bool delta = false;
  static constexpr bool infinite = false;

  // Points nearer than this count as inside: those of the sphere itself must, on whichever side rounding puts them.
  static constexpr float most_outside = 0.9999f;

  // sin^2 of half the angle that the sphere fills; 1 or more inside.
  float sin2_max(Vec3 reference) const { return radius * radius / length_squared(reference - center); }
  Vec3 error() const {
    const float size = gamma(8) * radius;
    return fma(gamma(6), abs(center), Vec3{size, size, size});
  }
  Vec3 at(Vec2 u) const { return fma(radius, square_to_sphere(u), center); }
  float area() const { return 4.0f * pi * radius * radius; }
  // 1 - cos of half the angle, without the cancellation of small angles.
  static float one_minus_cos(float sin2) { return sin2 / (1.0f + sqrt(max(0.0f, 1.0f - sin2))); }

  LightSample sample(Vec3 reference, Vec2 u) const {
    const float sin2 = sin2_max(reference);
    if (!(sin2 < most_outside)) {
      const Vec3 n = square_to_sphere(u);
      return sample_towards(reference, fma(radius, n, center), error(), n, area());
    }
    // Angle from the axis, then the point where that direction enters the sphere (Pharr et al. 2023, section 6.2.4).
    const float height = one_minus_cos(sin2);
    const float drop = u.x * height;
    const float sin2_theta = drop * (2.0f - drop);
    const float cos_theta = 1.0f - drop;
    const float inverse_sin = 1.0f / sqrt(sin2);
    const float cos_alpha =
        fma(sin2_theta, inverse_sin, cos_theta * sqrt(max(0.0f, 1.0f - sin2_theta * inverse_sin * inverse_sin)));
    const float sin_alpha = sqrt(max(0.0f, 1.0f - cos_alpha * cos_alpha));
    const SinCos phi = sincos(2.0f * pi * u.y);
    const Frame frame = Frame::around(normalize(reference - center));
    const Vec3 n = frame.to_world({sin_alpha * phi.cos, sin_alpha * phi.sin, cos_alpha});
    LightSample s = sample_towards(reference, fma(radius, n, center), error(), n, area());
    s.pdf = 0.5f * inv_pi / height;
    return s;
  }

  float pdf(Vec3 reference, Vec3 wi, const Surface& at) const {
    const float sin2 = sin2_max(reference);
    if (sin2 < most_outside) return 0.5f * inv_pi / one_minus_cos(sin2);
    return area_to_solid_angle(area(), length_squared(at.point - reference), abs(dot(at.normal, wi)));
  }
  float power_per_radiance(float) const { return pi * area(); }
  LightBounds bounds() const {
    const Vec3 half = {radius, radius, radius};
    return {center - half, center + half, {0, 0, 1}, -1.0f, 0.0f};
  }
};

}  // namespace accuray
