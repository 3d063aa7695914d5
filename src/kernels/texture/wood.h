// Grown wood: rings around an axis, uneven by noise (after the example of Peachey 1985, "Solid Texturing of Complex
// Surfaces").
#pragma once

#include "kernels/texture/noise.h"

namespace accuray {

struct WoodTexture {
  Vec3 first, second;
  float size, turbulence;

  static constexpr const char* name = "wood";
  static constexpr const char* doc = "Year rings around the y axis of the shape's space, uneven by noise.";
  static constexpr bool reads_uv = false;
  static constexpr auto params() {
    return param_list(colour_param("first", "Colour of early wood, linear Rec.709.", "[0.55, 0.33, 0.15]",
                                   ACCURAY_OFFSET_OF(WoodTexture, first)),
                      colour_param("second", "Colour of late wood, linear Rec.709.", "[0.25, 0.11, 0.04]",
                                   ACCURAY_OFFSET_OF(WoodTexture, second)),
                      size_param("Width of a ring.", ACCURAY_OFFSET_OF(WoodTexture, size)),
                      Param{.name = "turbulence",
                            .kind = Kind::real,
                            .doc = "How uneven the rings are, in rings.",
                            .preset = "1",
                            .low = 0,
                            .high = 100,
                            .unit = "1",
                            .animatable = true,
                            .member = ACCURAY_OFFSET_OF(WoodTexture, turbulence)});
  }
  float step() const { return 0x1p-8f * size; }
  // Wood darkens slowly over the year and starts anew at once.
  TextureValue value(const SceneView&, const TexturePoint& p) const {
    const Vec3 q = p.point * (1.0f / size);
    const Vec3 slow = {0.25f * q.x, 0.05f * q.y, 0.25f * q.z};
    const float ring = fma(turbulence, octave_noise(slow, 3, 0.5f), sqrt(fma(q.x, q.x, q.z * q.z)));
    const float year = fraction_of(ring);
    const float dark = year < 0.8f ? year * year * (1.0f / 0.64f) : (1.0f - year) * 5.0f;
    return mixed(first, second, dark);
  }
};

}  // namespace accuray
