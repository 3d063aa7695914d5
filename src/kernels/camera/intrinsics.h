// A calibrated camera: the matrix K of computer vision, with lens distortion.
#pragma once

#include "kernels/camera/camera.h"
#include "kernels/camera/distortion.h"

namespace accuray {

struct PinholeIntrinsics {
  Pose pose;
  Vec2 scale, offset;  // from the film to the plane at distance 1, y down
  Distortion distortion;

  static constexpr const char* name = "pinhole_intrinsics";
  static constexpr const char* doc =
      "A calibrated pinhole: K and the distortion of OpenCV. Pixel (0, 0) has its middle at u = v = 0. Black with "
      "alpha 0 where the distortion leaves nothing to see.";
  static constexpr auto params() {
    return param_list(
        pixels("fx", "Focal length in pixels, across.", 1e-3, true),
        pixels("fy", "Focal length in pixels, down; by default fx.", 1e-3),
        pixels("cx", "Column of the principal point; by default the middle of the picture.", -1e6),
        pixels("cy", "Row of the principal point; by default the middle of the picture.", -1e6),
        pixels("image_width", "Width of the pictures that K was calibrated with; by default the film's.", 1),
        pixels("image_height", "Height of the pictures that K was calibrated with; by default the film's.", 1),
        coefficient("k1", "Radial distortion, squared radius.", ACCURAY_OFFSET_OF(PinholeIntrinsics, distortion.k1)),
        coefficient("k2", "Radial distortion, fourth power.", ACCURAY_OFFSET_OF(PinholeIntrinsics, distortion.k2)),
        coefficient("k3", "Radial distortion, sixth power.", ACCURAY_OFFSET_OF(PinholeIntrinsics, distortion.k3)),
        coefficient("k4", "As k1, in the denominator.", ACCURAY_OFFSET_OF(PinholeIntrinsics, distortion.k4)),
        coefficient("k5", "As k2, in the denominator.", ACCURAY_OFFSET_OF(PinholeIntrinsics, distortion.k5)),
        coefficient("k6", "As k3, in the denominator.", ACCURAY_OFFSET_OF(PinholeIntrinsics, distortion.k6)),
        coefficient("p1", "Tangential distortion, down.", ACCURAY_OFFSET_OF(PinholeIntrinsics, distortion.p1)),
        coefficient("p2", "Tangential distortion, across.", ACCURAY_OFFSET_OF(PinholeIntrinsics, distortion.p2)));
  }

  static constexpr bool has_lens = false;

  CameraRay ray(Vec2 film, Vec2 /*lens*/, float time) const {
    Vec2 p{};
    if (!distortion.undistort({fma(film.x, scale.x, offset.x), fma(film.y, scale.y, offset.y)}, p)) {
      return {{pose.position, -pose.backward, infinity, time}, false};
    }
    return {{pose.position, normalize(pose.to_world(p.x, -p.y, -1.0f)), infinity, time}};
  }

 private:
  static constexpr Param pixels(const char* name, const char* doc, double low, bool required = false) {
    return {.name = name,
            .kind = Kind::real,
            .doc = doc,
            .low = low,
            .high = 1e6,
            .unit = "px",
            .required = required,
            .animatable = true};
  }
  static constexpr Param coefficient(const char* name, const char* doc, uint32_t member) {
    return {.name = name,
            .kind = Kind::real,
            .doc = doc,
            .preset = "0",
            .low = -1e6,
            .high = 1e6,
            .animatable = true,
            .member = member};
  }
};

}  // namespace accuray
