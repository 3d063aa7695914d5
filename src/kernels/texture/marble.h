// Veined stone: stripes bent by noise (Perlin 1985, "An Image Synthesizer").
#pragma once

#include "kernels/math/functions.h"
#include "kernels/texture/noise.h"

namespace accuray {

struct MarbleTexture {
  Vec3 first, second;
  float size, turbulence;
  int32_t octaves;

  static constexpr const char* name = "marble";
  static constexpr const char* doc = "Veins across the x axis of the shape's space, bent by noise.";
  static constexpr bool reads_uv = false;
  static constexpr auto params() {
    return param_list(colour_param("first", "Colour of the veins, linear Rec.709.", "[0.25, 0.25, 0.28]",
                                   ACCURAY_OFFSET_OF(MarbleTexture, first)),
                      colour_param("second", "Colour of the stone, linear Rec.709.", "[0.85, 0.84, 0.8]",
                                   ACCURAY_OFFSET_OF(MarbleTexture, second)),
                      size_param("Distance of the veins.", ACCURAY_OFFSET_OF(MarbleTexture, size)),
                      Param{.name = "turbulence",
                            .kind = Kind::real,
                            .doc = "How far noise moves the veins, in distances.",
                            .preset = "1",
                            .low = 0,
                            .high = 100,
                            .unit = "1",
                            .animatable = true,
                            .member = ACCURAY_OFFSET_OF(MarbleTexture, turbulence)},
                      octaves_param("6", ACCURAY_OFFSET_OF(MarbleTexture, octaves)));
  }
  float step() const { return 0x1p-8f * size; }
  TextureValue value(const SceneView&, const TexturePoint& p) const {
    const Vec3 q = p.point * (1.0f / size);
    const float stripe = fma(turbulence, octave_noise(q, static_cast<uint32_t>(octaves), 0.5f), q.x);
    const float s = sincos(pi * fraction_of(stripe)).sin;
    return mixed(first, second, sqrt(max(0.0f, s)));
  }
};

}  // namespace accuray
