// A chequered pattern.
#pragma once

#include "kernels/texture/texture.h"

namespace accuray {

struct CheckerTexture {
  UvMap map;
  Vec3 first, second;

  static constexpr const char* name = "checker";
  static constexpr const char* doc =
      "Squares of two colours in turn: two by two of them where u and v run from 0 to 1.";
  static constexpr bool reads_uv = true;
  static constexpr auto params() {
    return joined(param_list(colour_param("first", "Colour of the square at uv (0, 0), linear Rec.709.",
                                          "[0.8, 0.8, 0.8]", ACCURAY_OFFSET_OF(CheckerTexture, first)),
                             colour_param("second", "Colour of its neighbours, linear Rec.709.", "[0.2, 0.2, 0.2]",
                                          ACCURAY_OFFSET_OF(CheckerTexture, second))),
                  uv_params());
  }
  float step() const { return 0x1p-8f; }
  TextureValue value(const SceneView&, const TexturePoint& p) const {
    const Vec2 uv = map.at(p.uv);
    return opaque((fraction_of(uv.x) < 0.5f) == (fraction_of(uv.y) < 0.5f) ? first : second);
  }
};

}  // namespace accuray
