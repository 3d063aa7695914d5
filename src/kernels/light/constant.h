// An environment of the same radiance in every direction.
#pragma once

#include "kernels/light/light.h"

namespace accuray {

struct ConstantLight {
  float unused;  // no parameter but the radiance, which the LightRecord holds

  static constexpr bool delta = false;
  static constexpr bool infinite = true;
  static constexpr const char* name = "constant";
  static constexpr const char* doc = "An infinitely distant environment of equal radiance in all directions.";
  static constexpr auto params() {
    return param_list(Param{.name = "radiance",
                            .kind = Kind::spectrum,
                            .doc = "Spectral radiance.",
                            .preset = "1",
                            .low = 0,
                            .unit = "W/(m^2 sr nm)",
                            .role = "emission",
                            .animatable = true});
  }

  LightSample sample(Vec3, Vec2 u) const {
    return {square_to_sphere(u), {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, infinity, uniform_sphere_pdf, 1.0f};
  }
  float pdf(Vec3, Vec3, const Surface&) const { return uniform_sphere_pdf; }
  // Flux into a sphere around the scene.
  float power_per_radiance(float scene_radius) const { return 4.0f * pi * pi * scene_radius * scene_radius; }
};

}  // namespace accuray
