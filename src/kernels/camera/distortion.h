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

  // Finds the point that appears at `seen`; false if there is none. The radial part alone is inverted first, safely
  // between 0 and the limit; Newton's iteration in the plane then adds the tangential part.
  bool undistort(Vec2 seen, Vec2& p) const {
    p = seen;
    if (limit == 0.0f) return true;
    const float distance = sqrt(fma(seen.x, seen.x, seen.y * seen.y));
    const float ratio = distance > 0.0f ? undistorted_radius(distance) / distance : 1.0f;
    p = {seen.x * ratio, seen.y * ratio};
    Image image = distort(p);
    for (int32_t i = 0; i < 6; ++i) {
      const Vec2 error = {image.point.x - seen.x, image.point.y - seen.y};
      const float determinant = difference_of_products(image.xx, image.yy, image.xy, image.xy);
      if (!(determinant > 0.0f)) return false;
      p.x -= (image.yy * error.x - image.xy * error.y) / determinant;
      p.y -= (image.xx * error.y - image.xy * error.x) / determinant;
      image = distort(p);
    }
    const Vec2 error = {image.point.x - seen.x, image.point.y - seen.y};
    const float tolerance = 1e-5f;
    return fma(p.x, p.x, p.y * p.y) <= limit * (1.0f + tolerance) &&
           fma(error.x, error.x, error.y * error.y) <= tolerance * tolerance * fma(distance, distance, 1.0f);
  }

 private:
  // The radial factor R at the squared radius s, and its derivative there.
  struct Factor {
    float value, slope;
  };
  Factor radial(float s) const {
    const float above = fma(s, fma(s, fma(s, k3, k2), k1), 1.0f);
    const float below = fma(s, fma(s, fma(s, k6, k5), k4), 1.0f);
    const float above_slope = fma(s, fma(s, 3.0f * k3, 2.0f * k2), k1);
    const float below_slope = fma(s, fma(s, 3.0f * k6, 2.0f * k5), k4);
    const float value = above / below;
    return {value, (above_slope - value * below_slope) / below};
  }

  // Where a point appears, and the derivatives of that, a symmetric matrix.
  struct Image {
    Vec2 point;
    float xx, xy, yy;
  };
  Image distort(Vec2 p) const {
    const float s = fma(p.x, p.x, p.y * p.y);
    const Factor r = radial(s);
    const float slope = 2.0f * r.slope;
    const float xy = p.x * p.y;
    Image image;
    image.point.x = p.x * r.value + 2.0f * p1 * xy + p2 * fma(2.0f * p.x, p.x, s);
    image.point.y = p.y * r.value + p1 * fma(2.0f * p.y, p.y, s) + 2.0f * p2 * xy;
    image.xx = r.value + p.x * p.x * slope + 2.0f * p1 * p.y + 6.0f * p2 * p.x;
    image.xy = xy * slope + 2.0f * p1 * p.x + 2.0f * p2 * p.y;
    image.yy = r.value + p.y * p.y * slope + 6.0f * p1 * p.y + 2.0f * p2 * p.x;
    return image;
  }

  // The radius r with r R(r^2) = seen, by Newton's iteration that bisects where it would leave its bracket.
  float undistorted_radius(float seen) const {
    float low = 0.0f;
    float high = sqrt(limit);
    float r = min(seen, 0.5f * high);
    for (int32_t i = 0; i < 32; ++i) {
      const Factor factor = radial(r * r);
      const float error = r * factor.value - seen;
      if (error > 0.0f) {
        high = r;
      } else {
        low = r;
      }
      float next = r - error / fma(2.0f * r * r, factor.slope, factor.value);
      if (!(next > low && next < high)) next = 0.5f * (low + high);
      if (abs(next - r) <= 1e-6f * r) return next;
      r = next;
    }
    return r;
  }
};

}  // namespace accuray
