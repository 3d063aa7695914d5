// Lens distortion as OpenCV's calibration describes it: radial with a rational factor, and tangential (Brown 1966; the
// model and its names: OpenCV, "Camera Calibration and 3D Reconstruction").
//
// Coordinates are those of the plane at distance 1, x to the right and y down. With s = x^2 + y^2 and
//   R = (1 + k1 s + k2 s^2 + k3 s^3) / (1 + k4 s + k5 s^2 + k6 s^3)
// the undistorted point (x, y) appears at
//   (x R + 2 p1 x y + p2 (s + 2 x^2),  y R + p1 (s + 2 y^2) + 2 p2 x y).
#pragma once

#include "kernels/math/vec.h"

namespace accuray {

struct Distortion {
  float k1, k2, k3, k4, k5, k6;
  float p1, p2;
  float limit;  // squared radius up to which the radial part grows with the radius; 0: there is no distortion

  // Where a point appears, and the derivatives of that, a symmetric matrix.
  struct Image {
    Vec2 point;
    float xx, xy, yy;
  };
  Image distort(Vec2 p) const {
    const float s = fma(p.x, p.x, p.y * p.y);
    const float above = fma(s, fma(s, fma(s, k3, k2), k1), 1.0f);
    const float below = fma(s, fma(s, fma(s, k6, k5), k4), 1.0f);
    const float above_slope = fma(s, fma(s, 3.0f * k3, 2.0f * k2), k1);
    const float below_slope = fma(s, fma(s, 3.0f * k6, 2.0f * k5), k4);
    const float r = above / below;
    const float slope = 2.0f * (above_slope - r * below_slope) / below;
    const float xy = p.x * p.y;
    Image image;
    image.point.x = p.x * r + 2.0f * p1 * xy + p2 * fma(2.0f * p.x, p.x, s);
    image.point.y = p.y * r + p1 * fma(2.0f * p.y, p.y, s) + 2.0f * p2 * xy;
    image.xx = r + p.x * p.x * slope + 2.0f * p1 * p.y + 6.0f * p2 * p.x;
    image.xy = xy * slope + 2.0f * p1 * p.x + 2.0f * p2 * p.y;
    image.yy = r + p.y * p.y * slope + 6.0f * p1 * p.y + 2.0f * p2 * p.x;
    return image;
  }

  // Finds the point that appears at `seen`, by Newton's iteration inside the limit; false if there is none.
  bool undistort(Vec2 seen, Vec2& p) const {
    p = seen;
    if (limit == 0.0f) return true;
    p = within_limit(p);
    for (int32_t i = 0; i < 20; ++i) {
      const Image image = distort(p);
      const Vec2 error = {image.point.x - seen.x, image.point.y - seen.y};
      const float determinant = difference_of_products(image.xx, image.yy, image.xy, image.xy);
      if (!(determinant > 0.0f)) return false;
      const Vec2 step = {(image.yy * error.x - image.xy * error.y) / determinant,
                         (image.xx * error.y - image.xy * error.x) / determinant};
      p = within_limit({p.x - step.x, p.y - step.y});
      if (step.x * step.x + step.y * step.y <= 1e-13f * (1.0f + p.x * p.x + p.y * p.y)) break;
    }
    const Image image = distort(p);
    const Vec2 error = {image.point.x - seen.x, image.point.y - seen.y};
    return error.x * error.x + error.y * error.y <= 1e-10f * (1.0f + seen.x * seen.x + seen.y * seen.y);
  }

 private:
  Vec2 within_limit(Vec2 p) const {
    const float s = fma(p.x, p.x, p.y * p.y);
    if (!(s > limit)) return p;
    const float shrink = sqrt(limit / s);
    return {p.x * shrink, p.y * shrink};
  }
};

}  // namespace accuray
