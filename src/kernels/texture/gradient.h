// A continuous transition between two colours.
#pragma once

#include "kernels/texture/texture.h"

namespace accuray {

struct GradientTexture {
  UvMap map;
  Vec3 first, second;
  uint32_t radial;

  static constexpr const char* name = "gradient";
  static constexpr const char* doc = "A transition from one colour to another; beyond its ends the colours go on.";
  static constexpr bool reads_uv = true;
  static constexpr auto params() {
    return joined(
        param_list(colour_param("first", "Colour at the start, linear Rec.709.", "[0, 0, 0]",
                                ACCURAY_OFFSET_OF(GradientTexture, first)),
                   colour_param("second", "Colour at the end, linear Rec.709.", "[1, 1, 1]",
                                ACCURAY_OFFSET_OF(GradientTexture, second)),
                   Param{.name = "course",
                         .kind = Kind::choice,
                         .doc = "linear: from u = 0 to u = 1; radial: from uv (0.5, 0.5) to a circle of radius 0.5.",
                         .preset = "\"linear\"",
                         .choices = "linear|radial",
                         .member = ACCURAY_OFFSET_OF(GradientTexture, radial)}),
        uv_params());
  }
  float step() const { return 0x1p-8f; }
  TextureValue value(const SceneView&, const TexturePoint& p) const {
    const Vec2 uv = map.at(p.uv);
    const float x = 2.0f * uv.x - 1.0f;
    const float y = 2.0f * uv.y - 1.0f;
    const float along = radial != 0 ? sqrt(fma(x, x, y * y)) : uv.x;
    return mixed(first, second, min(max(0.0f, along), 1.0f));
  }
};

}  // namespace accuray
