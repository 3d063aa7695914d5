// Lenses of up to all directions: the distance from the picture's middle is a function of the angle to the axis.
#pragma once

#include "kernels/camera/camera.h"
#include "kernels/math/functions.h"

namespace accuray {

enum class FisheyeMapping : uint32_t { equidistant, equisolid, stereographic, orthographic };

struct Fisheye {
  Pose pose;
  FisheyeMapping mapping;
  float extent_x, extent_y;  // half the picture's width and height in radii of the image circle
  float scale;               // what the mapping's inverse takes at the edge of the image circle

  static constexpr const char* name = "fisheye";
  static constexpr const char* doc =
      "A round picture of a wide field, black with alpha 0 outside of it. With the angle t to the axis, the distance "
      "from the middle is proportional to t (equidistant), sin(t/2) (equisolid: to solid angle by area), tan(t/2) "
      "(stereographic: circles stay circles) or sin(t) (orthographic).";
  static constexpr auto params() {
    return param_list(
        Param{.name = "fov",
              .kind = Kind::real,
              .doc = "Field of view across the image circle; at most 180 for the orthographic mapping and 359 for the "
                     "stereographic one.",
              .preset = "180",
              .low = 1e-3,
              .high = 360,
              .unit = "deg",
              .animatable = true},
        Param{.name = "fov_axis",
              .kind = Kind::choice,
              .doc = "Side of the picture, or its diagonal, that is as long as the image circle's diameter.",
              .preset = "\"vertical\"",
              .choices = "vertical|horizontal|diagonal"},
        Param{.name = "mapping",
              .kind = Kind::choice,
              .doc = "How the angle to the axis becomes a distance from the picture's middle.",
              .preset = "\"equidistant\"",
              .choices = "equidistant|equisolid|stereographic|orthographic",
              .member = ACCURAY_OFFSET_OF(Fisheye, mapping)});
  }

  static constexpr bool has_lens = false;

  CameraRay ray(Vec2 film, Vec2 /*lens*/, float time) const {
    const float x = (2.0f * film.x - 1.0f) * extent_x;
    const float y = (1.0f - 2.0f * film.y) * extent_y;
    const float radius = sqrt(fma(x, x, y * y));
    if (!(radius <= 1.0f)) return {{pose.position, -pose.backward, infinity, time}, false};
    const SinCos angle = sincos(angle_at(radius * scale));
    const float ratio = radius > 0.0f ? angle.sin / radius : 0.0f;
    const Vec3 direction = pose.to_world(x * ratio, y * ratio, -angle.cos);
    return {{pose.position, normalize(direction), infinity, time}};
  }

 private:
  // Angle to the axis, from the scaled distance to the middle.
  float angle_at(float r) const {
    switch (mapping) {
      case FisheyeMapping::equisolid:
        return 2.0f * asin(min(r, 1.0f));
      case FisheyeMapping::stereographic:
        return 2.0f * atan(r);
      case FisheyeMapping::orthographic:
        return asin(min(r, 1.0f));
      default:
        return r;
    }
  }
};

}  // namespace accuray
