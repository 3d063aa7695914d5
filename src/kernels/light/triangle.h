// One emissive triangle, sampled by solid angle where it is large and by area where it is small.
#pragma once

#include "kernels/light/light.h"

namespace accuray {

// Solid angle of a spherical triangle of unit vectors (Van Oosterom and Strackee 1983).
inline float spherical_triangle_area(Vec3 a, Vec3 b, Vec3 c) {
  const float numerator = abs(dot(a, cross(b, c)));
  const float denominator = 1.0f + dot(a, b) + dot(b, c) + dot(c, a);
  return 2.0f * atan2(numerator, denominator);
}

// Part of v perpendicular to the unit vector w, normalised.
inline Vec3 perpendicular(Vec3 v, Vec3 w) { return normalize(fma(-dot(v, w), w, v)); }

// Uniform direction in a spherical triangle (Arvo 1995, "Stratified Sampling of Spherical Triangles").
inline Vec3 sample_spherical_triangle(Vec3 a, Vec3 b, Vec3 c, float area, Vec2 u) {
  const Vec3 n_ab = normalize(cross(a, b));
  const Vec3 n_ca = normalize(cross(c, a));
  const float cos_alpha = clamp(-dot(n_ab, n_ca), -1.0f, 1.0f);
  const float sin_alpha = sqrt(max(0.0f, 1.0f - cos_alpha * cos_alpha));
  // The sub-triangle a, b, c' with the share u.x of the area: angle at b from the sub-area.
  const SinCos s = sincos(u.x * area);
  const float sin_phi = s.sin * cos_alpha - s.cos * sin_alpha;
  const float cos_phi = s.cos * cos_alpha + s.sin * sin_alpha;
  const float k1 = cos_phi - cos_alpha;
  const float k2 = sin_phi + sin_alpha * dot(a, b);
  const float denominator = (k2 * sin_phi + k1 * cos_phi) * sin_alpha;
  const float cos_b = denominator == 0.0f ? 1.0f : ((k2 * cos_phi - k1 * sin_phi) * cos_alpha - k2) / denominator;
  const float cos_bp = clamp(cos_b, -1.0f, 1.0f);
  const Vec3 cp = fma(cos_bp, a, perpendicular(c, a) * sqrt(max(0.0f, 1.0f - cos_bp * cos_bp)));
  const float cos_theta = 1.0f - u.y * (1.0f - dot(cp, b));
  const float sin_theta = sqrt(max(0.0f, 1.0f - cos_theta * cos_theta));
  return fma(cos_theta, b, perpendicular(cp, b) * sin_theta);
}

// Arvo's inversion loses digits sooner than the rectangle's, most of all for thin triangles.
constexpr float least_spherical_triangle = 0.02f;

struct TriangleLight {
  Vec3 p0, p1, p2;
  Vec3 normal;
  Vec3 error;
  float area;

  static constexpr bool delta = false;
  static constexpr bool infinite = false;

  // A point chosen uniformly by area.
  Vec3 at(Vec2 u) const {
    const Vec2 b = square_to_triangle(u);
    return fma(b.x, p1 - p0, fma(b.y, p2 - p0, p0));
  }
  // The triangle as seen from a reference.
  struct Seen {
    Vec3 a, b, c;
    float solid_angle;  // 0: to be sampled by area
  };
  Seen seen_from(Vec3 reference) const {
    const Vec3 middle = (p0 + p1 + p2) * (1.0f / 3.0f);
    const float radius_squared =
        max(length_squared(p0 - middle), max(length_squared(p1 - middle), length_squared(p2 - middle)));
    Seen seen{};
    if (!is_near(reference, middle, radius_squared)) return seen;
    seen.a = normalize(p0 - reference);
    seen.b = normalize(p1 - reference);
    seen.c = normalize(p2 - reference);
    const float w = spherical_triangle_area(seen.a, seen.b, seen.c);
    seen.solid_angle = w > least_spherical_triangle && w < most_spherical ? w : 0.0f;
    return seen;
  }

  LightSample sample(Vec3 reference, Vec2 u) const {
    const Seen seen = seen_from(reference);
    if (seen.solid_angle > 0.0f) {
      const Vec3 wi = sample_spherical_triangle(seen.a, seen.b, seen.c, seen.solid_angle, u);
      const float t = dot(normal, p0 - reference) / dot(normal, wi);
      if (!(t > 0.0f && is_finite(t))) return no_light();
      return {wi, fma(t, wi, reference), error, normal, t, 1.0f / seen.solid_angle, 1.0f};
    }
    return sample_towards(reference, at(u), error, normal, area);
  }

  float pdf(Vec3 reference, Vec3 wi, const Surface& at) const {
    const Seen seen = seen_from(reference);
    if (seen.solid_angle > 0.0f) return 1.0f / seen.solid_angle;
    return area_to_solid_angle(area, length_squared(at.point - reference), abs(dot(normal, wi)));
  }
  float power_per_radiance(float) const { return pi * area; }
  LightBounds bounds() const { return {min(p0, min(p1, p2)), max(p0, max(p1, p2)), normal, 1.0f, 0.0f}; }
};

}  // namespace accuray
