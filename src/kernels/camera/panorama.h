// The whole sphere of directions as a map of longitude and latitude.
#pragma once

#include "kernels/camera/camera.h"
#include "kernels/math/functions.h"

namespace accuray {

struct Panorama {
  Pose pose;

  static constexpr const char* name = "panorama";
  static constexpr const char* doc =
      "All directions, equirectangular: longitude across, latitude down; look_at is in the middle, what lies behind at "
      "the left and right edge. Its natural picture is twice as wide as high.";
  static constexpr auto params() { return NoParams{}; }

  static constexpr bool has_lens = false;

  // Beyond the edges the map goes on: around the horizon, and over the poles to the other side.
  CameraRay ray(Vec2 film, Vec2 /*lens*/, float time) const {
    const SinCos longitude = sincos((film.x - 0.5f) * (2.0f * pi));
    const SinCos latitude = sincos((0.5f - film.y) * pi);
    const Vec3 direction = pose.to_world(latitude.cos * longitude.sin, latitude.sin, -(latitude.cos * longitude.cos));
    return {{pose.position, normalize(direction), infinity, time}};
  }
};

}  // namespace accuray
