// A point that sends the same radiant intensity in all directions.
#pragma once

#include "kernels/light/aim.h"

namespace accuray {

struct PointLight {
  Vec3 position;

  static constexpr bool delta = true;
  static constexpr bool infinite = false;
  static constexpr const char* name = "point";
  static constexpr const char* doc = "A point that radiates equally in all directions; no path can hit it.";
  static constexpr auto params() {
    return param_list(Param{.name = "position",
                            .kind = Kind::vec,
                            .doc = "Where it is.",
                            .preset = "[0, 0, 0]",
                            .unit = "m",
                            .animatable = true,
                            .member = ACCURAY_OFFSET_OF(PointLight, position)},
                      Param{.name = "intensity",
                            .kind = Kind::spectrum,
                            .doc = "Spectral radiant intensity.",
                            .preset = "1",
                            .low = 0,
                            .unit = "W/(sr nm)",
                            .role = "emission",
                            .takes_flux = true,
                            .animatable = true});
  }

  LightSample sample(Vec3 reference, Vec2) const { return sample_point(reference, position); }
  float pdf(Vec3, Vec3, const Surface&) const { return 0.0f; }
  float power_per_radiance(float) const { return 4.0f * pi; }
  LightBounds bounds() const { return {position, position, {0, 0, 1}, -1.0f, 0.0f}; }
};

}  // namespace accuray
