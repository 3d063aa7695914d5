// A pinhole camera.
#pragma once

#include "kernels/geometry/ray.h"
#include "kernels/scene_view.h"
#include "kernels/schema.h"

namespace accuray {

struct Perspective {
  Vec3 position;
  Vec3 right, up, backward;       // the camera looks down its own -z
  float half_width, half_height;  // of the picture at distance 1

  static constexpr const char* name = "perspective";
  static constexpr const char* doc = "A pinhole camera: everything is in focus, straight lines stay straight.";
  static constexpr auto params() {
    return param_list(
        Param{.name = "position",
              .kind = Kind::vec,
              .doc = "Eye point.",
              .preset = "[0, 0, 5]",
              .unit = "m",
              .animatable = true},
        Param{.name = "look_at",
              .kind = Kind::vec,
              .doc = "Point in the middle of the picture.",
              .preset = "[0, 0, 0]",
              .unit = "m",
              .animatable = true},
        Param{.name = "up",
              .kind = Kind::vec,
              .doc = "Direction that is up in the picture.",
              .preset = "[0, 1, 0]",
              .animatable = true},
        Param{.name = "fov",
              .kind = Kind::real,
              .doc = "Field of view.",
              .preset = "40",
              .low = 1e-4,
              .high = 179.99,
              .unit = "deg",
              .group = "field:fov",
              .animatable = true},
        Param{.name = "fov_axis",
              .kind = Kind::choice,
              .doc = "Axis of the picture that fov and film_size are measured on.",
              .preset = "\"vertical\"",
              .choices = "vertical|horizontal"},
        Param{.name = "focal_length",
              .kind = Kind::real,
              .doc = "Focal length; a bare number is in metres whatever length_unit says.",
              .low = 1e-6,
              .unit = "m",
              .role = "absolute",
              .group = "field:film",
              .animatable = true},
        Param{.name = "film_size",
              .kind = Kind::real,
              .doc = "Size of the film on fov_axis; a bare number is in metres whatever length_unit says.",
              .low = 1e-6,
              .unit = "m",
              .role = "absolute",
              .group = "field:film",
              .animatable = true});
  }

  // x, y in [0, 1] from the upper left corner of the picture.
  Ray ray(Vec2 film, Vec2 /*lens*/, float time) const {
    const float x = (2.0f * film.x - 1.0f) * half_width;
    const float y = (1.0f - 2.0f * film.y) * half_height;
    return {position, normalize(fma(x, right, fma(y, up, -backward))), infinity, time};
  }
};

}  // namespace accuray
