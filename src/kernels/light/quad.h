// An emissive rectangle (two triangles of a mesh that form one), sampled by solid angle where it is large.
#pragma once

#include "kernels/light/triangle.h"

namespace accuray {

// The rectangle as seen from a reference point: Urena, Fajardo and King 2013, "An Area-Preserving Parametrization for
// Spherical Rectangles". Names follow the paper. Departure: the inner angles g_i = acos(-t_i) enter as
// pi/2 + asin(t_i), because the sum of four acos cancels for small rectangles.
struct SphericalRectangle {
  Vec3 x, y, z;  // local frame with the rectangle at z0 < 0
  float x0, x1, y0, y1, z0;
  float b0, b1, k;
  float area;  // solid angle

  static SphericalRectangle of(Vec3 reference, Vec3 corner, Vec3 x, Vec3 y, float width, float height) {
    SphericalRectangle r;
    r.x = x;
    r.y = y;
    r.z = cross(x, y);
    const Vec3 d = corner - reference;
    r.x0 = dot(d, x);
    r.y0 = dot(d, y);
    r.z0 = dot(d, r.z);
    r.x1 = r.x0 + width;
    r.y1 = r.y0 + height;
    if (r.z0 > 0.0f) {
      r.z = -r.z;
      r.z0 = -r.z0;
    }
    // z components of the normals of the planes through the reference and each edge.
    const float zz = r.z0 * r.z0;
    const float n0 = -r.y0 / sqrt(fma(r.y0, r.y0, zz));
    const float n1 = r.x1 / sqrt(fma(r.x1, r.x1, zz));
    const float n2 = r.y1 / sqrt(fma(r.y1, r.y1, zz));
    const float n3 = -r.x0 / sqrt(fma(r.x0, r.x0, zz));
    const float a2 = asin(n2 * n3);
    const float a3 = asin(n3 * n0);
    r.area = asin(n0 * n1) + asin(n1 * n2) + a2 + a3;
    r.b0 = n0;
    r.b1 = n2;
    r.k = -a2 - a3;  // the paper's k - pi
    return r;
  }

  // Unnormalised direction to a uniformly chosen point, in world space.
  Vec3 sample(Vec2 u) const {
    const SinCos a = sincos(fma(u.x, area, k));
    const float fu = fma(a.cos, b0, b1) / a.sin;
    const float magnitude = 1.0f / sqrt(fma(fu, fu, b0 * b0));
    const float cu = clamp(fu > 0.0f ? magnitude : -magnitude, -one_minus_epsilon, one_minus_epsilon);
    const float xu = clamp(-(cu * z0) / sqrt(1.0f - cu * cu), x0, x1);
    const float d2 = fma(xu, xu, z0 * z0);
    const float h0 = y0 / sqrt(fma(y0, y0, d2));
    const float h1 = y1 / sqrt(fma(y1, y1, d2));
    const float hv = fma(u.y, h1 - h0, h0);
    const float yv = hv * hv < one_minus_epsilon ? clamp(hv * sqrt(d2 / (1.0f - hv * hv)), y0, y1) : y1;
    return fma(xu, x, fma(yv, y, z * z0));
  }
};

struct QuadLight {
  Vec3 corner;
  Vec3 x, y;  // unit, perpendicular
  Vec3 normal;
  Vec3 error;
  float width, height;

  static constexpr bool delta = false;
  static constexpr bool infinite = false;

  Vec3 at(Vec2 u) const { return fma(u.x * width, x, fma(u.y * height, y, corner)); }
  float area() const { return width * height; }
  // Whether the rectangle is to be sampled by solid angle; then `seen` is filled.
  bool spherical(Vec3 reference, SphericalRectangle& seen) const {
    if (!is_near(reference, at({0.5f, 0.5f}), 0.25f * fma(width, width, height * height))) return false;
    seen = SphericalRectangle::of(reference, corner, x, y, width, height);
    return seen.area > least_spherical && seen.area < most_spherical;
  }

  LightSample sample(Vec3 reference, Vec2 u) const {
    SphericalRectangle seen;
    if (!spherical(reference, seen)) return sample_towards(reference, at(u), error, normal, area());
    const Vec3 d = seen.sample(u);
    const float distance = length(d);
    return {d * (1.0f / distance), reference + d, error, normal, distance, 1.0f / seen.area, 1.0f};
  }

  float pdf(Vec3 reference, Vec3 wi, const Surface& on_light) const {
    SphericalRectangle seen;
    if (spherical(reference, seen)) return 1.0f / seen.area;
    return area_to_solid_angle(area(), length_squared(on_light.point - reference), abs(dot(normal, wi)));
  }
  float power_per_radiance(float) const { return pi * area(); }
  LightBounds bounds() const {
    const Vec3 a = corner;
    const Vec3 b = at({1, 0});
    const Vec3 c = at({0, 1});
    const Vec3 d = at({1, 1});
    return {min(min(a, b), min(c, d)), max(max(a, b), max(c, d)), normal, 1.0f, 0.0f};
  }
};

}  // namespace accuray
