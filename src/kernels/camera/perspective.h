// Straight lines stay straight: a pinhole, or with an aperture a thin lens (thin_lens.h, which the lowering chooses).
#pragma once

#include "kernels/camera/aperture.h"
#include "kernels/camera/camera.h"

namespace accuray {

struct Perspective {
  Pose pose;
  float half_width, half_height;  // of the picture at distance 1
  float middle_x, middle_y;       // of the picture there: lens shift

  static constexpr const char* name = "perspective";
  static constexpr const char* doc =
      "A pinhole, with everything in focus, or a thin lens if it has an aperture; straight lines stay straight.";
  static constexpr auto projection_params() {
    return param_list(
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
              .animatable = true},
        Param{.name = "shift_x",
              .kind = Kind::real,
              .doc = "Lens shift: moves the frame to the right by this part of the picture's width.",
              .preset = "0",
              .low = -10,
              .high = 10,
              .animatable = true},
        Param{.name = "shift_y",
              .kind = Kind::real,
              .doc = "Lens shift: moves the frame up by this part of the picture's height.",
              .preset = "0",
              .low = -10,
              .high = 10,
              .animatable = true});
  }
  static constexpr auto params() { return joined(projection_params(), Aperture::params()); }

  static constexpr bool has_lens = false;

  // The point at distance 1 that a point of the film shows, in the camera's axes.
  Vec2 at_unit_distance(Vec2 film) const {
    return {fma(2.0f * film.x - 1.0f, half_width, middle_x), fma(1.0f - 2.0f * film.y, half_height, middle_y)};
  }

  CameraRay ray(Vec2 film, Vec2 /*lens*/, float time) const {
    const Vec2 p = at_unit_distance(film);
    return {{pose.position, normalize(pose.to_world(p.x, p.y, -1.0f)), infinity, time}};
  }
};

}  // namespace accuray
