// A thin lens: rays from all over the aperture meet in the plane in focus (Potmesil and Chakravarty 1982; Cook, Porter
// and Carpenter 1984). Scenes name it as a perspective camera with an aperture.
#pragma once

#include "kernels/camera/perspective.h"

namespace accuray {

struct ThinLens {
  Perspective pinhole;  // through the middle of the lens
  Aperture aperture;
  float inverse_focus;  // one over the distance of the plane in focus

  static constexpr bool has_lens = true;

  // The ray from the lens's point to the point that the pinhole shows in the plane in focus. Both are divided by that
  // plane's distance, so that a focus at infinity is no special case.
  CameraRay ray(Vec2 film, Vec2 lens, float time) const {
    const Pose& pose = pinhole.pose;
    const Vec2 p = pinhole.at_unit_distance(film);
    const Vec2 a = aperture.sample(lens);
    const Vec3 direction = pose.to_world(fma(-a.x, inverse_focus, p.x), fma(-a.y, inverse_focus, p.y), -1.0f);
    return {{fma(a.x, pose.right, fma(a.y, pose.up, pose.position)), normalize(direction), infinity, time}};
  }
};

}  // namespace accuray
