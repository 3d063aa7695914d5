// What all cameras share.
//
// Conventions:
//   - A camera's own axes are x to the right, y up, and it looks along -z.
//   - `film` is a point of the whole picture, (0, 0) its upper left and (1, 1) its lower right corner; pixel filters
//     reach a little beyond. `lens` is a point of the unit square that becomes a point of the aperture, uniform by
//     area.
//   - ray() answers with a unit direction. The picture shows the mean radiance of the rays, each with weight 1: a wall
//     of constant radiance is constant in every camera, without vignetting and without the cos^4 of irradiance.
//   - Where no light reaches the film (outside a fisheye's image circle) `seen` is false: black with alpha 0.
//   - A camera whose ray() reads `lens` says has_lens = true; for the others the numbers are not drawn.
#pragma once

#include "kernels/geometry/ray.h"
#include "kernels/schema.h"

namespace accuray {

struct CameraRay {
  Ray ray;
  bool seen = true;
};

// Where a camera stands: its position and its axes in the world.
struct Pose {
  Vec3 position;
  Vec3 right, up, backward;

  Vec3 to_world(float x, float y, float z) const { return fma(x, right, fma(y, up, z * backward)); }
};

// What every camera of a scene says.
struct CameraCommon {
  static constexpr auto params() {
    return param_list(
        Param{.name = "position",
              .kind = Kind::vec,
              .doc = "Eye point.",
              .preset = "[0, 0, 5]",
              .low = -1e12,
              .high = 1e12,
              .unit = "m",
              .animatable = true},
        Param{.name = "look_at",
              .kind = Kind::vec,
              .doc = "Point on the camera's axis: in the middle of the picture unless a lens shift moves it.",
              .preset = "[0, 0, 0]",
              .low = -1e12,
              .high = 1e12,
              .unit = "m",
              .animatable = true},
        Param{.name = "up",
              .kind = Kind::vec,
              .doc = "Direction that is up in the picture.",
              .preset = "[0, 1, 0]",
              .animatable = true},
        Param{.name = "transform",
              .kind = Kind::transform,
              .doc = "Moves and turns the camera, which then, unless position and look_at say otherwise, starts at the "
                     "origin and looks along -Z.",
              .animatable = true});
  }
};

}  // namespace accuray
