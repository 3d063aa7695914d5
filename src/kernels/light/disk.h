// An emissive disk, sampled by area.
#pragma once

#include "kernels/light/light.h"

namespace accuray {

struct DiskLight {
  Vec3 center;
  Vec3 normal;
  float radius;

  static constexpr bool delta = false;
  static constexpr bool infinite = false;

  float area() const { return pi * radius * radius; }

  Vec3 at(Vec2 u) const {
    const Vec2 d = square_to_disk(u);
    const Frame frame = Frame::around(normal);
    return fma(d.x * radius, frame.x, fma(d.y * radius, frame.y, center));
  }
  LightSample sample(Vec3 reference, Vec2 u) const {
    const float size = gamma(6) * radius;
    return sample_towards(reference, at(u), fma(gamma(10), abs(center), Vec3{size, size, size}), normal, area());
  }
  float pdf(Vec3 reference, Vec3 wi, const Surface& at) const {
    return area_to_solid_angle(area(), length_squared(at.point - reference), abs(dot(normal, wi)));
  }
  float power_per_radiance(float) const { return pi * area(); }
  LightBounds bounds() const {
    const Vec3 n = normal;
    const Vec3 half = {radius * sqrt(max(0.0f, 1.0f - n.x * n.x)), radius * sqrt(max(0.0f, 1.0f - n.y * n.y)),
                       radius * sqrt(max(0.0f, 1.0f - n.z * n.z))};
    return {center - half, center + half, normal, 1.0f, 0.0f};
  }
};

}  // namespace accuray
