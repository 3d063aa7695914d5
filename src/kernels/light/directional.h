// Parallel light from infinitely far away.
#pragma once

#include "kernels/light/light.h"
#include "kernels/schema.h"

namespace accuray {

struct DirectionalLight {
  Vec3 axis;  // unit: the way of the light

  static constexpr bool delta = true;
  static constexpr bool infinite = true;
  static constexpr const char* name = "directional";
  static constexpr const char* doc =
      "Parallel light from infinitely far away, with shadows of sharp edges; no path can hit it.";
  static constexpr auto params() {
    return param_list(Param{.name = "direction",
                            .kind = Kind::vec,
                            .doc = "The way of the light, of any length.",
                            .preset = "[0, -1, 0]",
                            .animatable = true},
                      Param{.name = "irradiance",
                            .kind = Kind::spectrum,
                            .doc = "Spectral irradiance of a surface that faces the light.",
                            .preset = "1",
                            .low = 0,
                            .unit = "W/(m^2 nm)",
                            .role = "emission",
                            .animatable = true});
  }

  LightSample sample(Vec3, Vec2) const { return {-axis, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, infinity, 1.0f, 1.0f}; }
  float pdf(Vec3, Vec3, const Surface&) const { return 0.0f; }
  float power_per_radiance(float scene_radius) const { return pi * scene_radius * scene_radius; }
};

}  // namespace accuray
