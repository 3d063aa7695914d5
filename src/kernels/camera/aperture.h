// The opening of a lens, and where it focuses.
#pragma once

#include "kernels/sampling/warp.h"
#include "kernels/schema.h"

namespace accuray {

struct Aperture {
  float radius;     // of the circle that holds it
  uint32_t blades;  // corners; 0: the circle itself
  float rotation;

  static constexpr auto params() {
    return param_list(
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

  // A point of the opening, uniform by area.
  Vec2 sample(Vec2 u) const {
    const Vec2 p = blades == 0 ? square_to_disk(u) : square_to_polygon(u, blades, rotation);
    return {radius * p.x, radius * p.y};
  }
};

}  // namespace accuray
