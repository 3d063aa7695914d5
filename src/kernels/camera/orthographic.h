// Parallel rays.
#pragma once

#include "kernels/camera/camera.h"

namespace accuray {

struct Orthographic {
  Pose pose;
  float half_width, half_height;

  static constexpr const char* name = "orthographic";
  static constexpr const char* doc =
      "Parallel rays, from a plane through position: equal things look equal at every distance.";
  static constexpr auto params() {
    return param_list(Param{.name = "height",
                            .kind = Kind::real,
                            .doc = "Height of what the picture shows; its width follows from the pixels.",
                            .preset = "2",
                            .low = 1e-9,
                            .high = 1e9,
                            .unit = "m",
                            .animatable = true});
  }

  static constexpr bool has_lens = false;

  CameraRay ray(Vec2 film, Vec2 /*lens*/, float time) const {
    const float x = (2.0f * film.x - 1.0f) * half_width;
    const float y = (1.0f - 2.0f * film.y) * half_height;
    return {{fma(x, pose.right, fma(y, pose.up, pose.position)), -pose.backward, infinity, time}};
  }
};

}  // namespace accuray
