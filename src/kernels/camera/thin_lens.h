// A thin lens: rays from all over the aperture meet in the plane in focus (Potmesil and Chakravarty 1982; Cook, Porter
// and Carpenter 1984). Scenes name it as a perspective camera with an aperture.
#pragma once

#include "kernels/camera/perspective.h"
#include "kernels/sampling/warp.h"

namespace accuray {

struct ThinLens {
  Perspective pinhole;  // through the middle of the lens
  float radius;         // of the circle that holds the aperture
  float inverse_focus;  // one over the distance of the plane in focus
  uint32_t blades;      // corners of the aperture; 0: a disk
  float blade_rotation;

  static constexpr bool has_lens = true;

  // The ray from the lens's point to the point that the pinhole shows in the plane in focus. Both are divided by that
  // plane's distance, so that a focus at infinity is no special case.
  CameraRay ray(Vec2 film, Vec2 lens, float time) const {
    const Pose& pose = pinhole.pose;
    const Vec2 p = pinhole.at_unit_distance(film);
    const Vec2 a = blades == 0 ? square_to_disk(lens) : square_to_polygon(lens, blades, blade_rotation);
    const float x = radius * a.x;
    const float y = radius * a.y;
    const Vec3 direction = pose.to_world(fma(-x, inverse_focus, p.x), fma(-y, inverse_focus, p.y), -1.0f);
    return {{fma(x, pose.right, fma(y, pose.up, pose.position)), normalize(direction), infinity, time}};
  }
};

}  // namespace accuray
