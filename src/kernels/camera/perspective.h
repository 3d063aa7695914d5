// Straight lines stay straight: a pinhole, or with an aperture a thin lens (thin_lens.h, which the lowering chooses).
#pragma once

#include "kernels/camera/camera.h"

namespace accuray {

struct Perspective {
  Pose pose;
  float half_width, half_height;  // of the picture at distance 1
  float middle_x, middle_y;       // of the picture there: lens shift

  static constexpr const char* name = "perspective";
  static constexpr const char* doc =
      "A pinhole, with everything in focus, or a thin lens if it has an aperture; straight lines stay straight.";
  static constexpr auto params() {
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
              .animatable = true},
        Param{.name = "aperture_radius",
              .kind = Kind::real,
              .doc = "Radius of the lens's opening, 0 for a pinhole; a bare number is in metres whatever length_unit "
                     "says.",
              .preset = "0",
              .low = 0,
              .high = 1e3,
              .unit = "m",
              .role = "absolute",
              .group = "aperture:radius",
              .animatable = true},
        Param{.name = "f_number",
              .kind = Kind::real,
              .doc = "Focal length over the diameter of the opening; needs focal_length and film_size.",
              .low = 0.01,
              .high = 1e6,
              .group = "aperture:f_number",
              .animatable = true},
        Param{.name = "focus_distance",
              .kind = Kind::real,
              .doc = "Distance of the plane in focus from the lens, along the axis; by default that of look_at.",
              .low = 1e-6,
              .high = 1e9,
              .unit = "m",
              .group = "focus?:distance",
              .animatable = true},
        Param{.name = "focus_point",
              .kind = Kind::vec,
              .doc = "A point of the plane in focus.",
              .low = -1e12,
              .high = 1e12,
              .unit = "m",
              .group = "focus?:point",
              .animatable = true},
        Param{.name = "blades",
              .kind = Kind::integer,
              .doc = "Blades of the aperture: a regular polygon with its corners on the circle of the opening; 0: the "
                     "circle itself.",
              .preset = "0",
              .low = 0,
              .high = 64},
        Param{.name = "blade_rotation",
              .kind = Kind::real,
              .doc = "Turns the polygon counter-clockwise as the picture shows it far behind the focus; at 0 a corner "
                     "points to the right.",
              .preset = "0",
              .unit = "deg",
              .animatable = true});
  }

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
