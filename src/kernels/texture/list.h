// All textures, and what parameters read from them. A new texture is a header beside these and a word here.
#pragma once

#include "kernels/dispatch.h"
#include "kernels/texture/checker.h"
#include "kernels/texture/gradient.h"
#include "kernels/texture/image.h"
#include "kernels/texture/marble.h"
#include "kernels/texture/noise.h"
#include "kernels/texture/wood.h"

namespace accuray {

using Textures = TypeList<ImageTexture, CheckerTexture, GradientTexture, NoiseTexture, WoodTexture, MarbleTexture>;

// Never inlined: scenes without textures shall not carry the code of all of them through every BSDF. Such functions
// take parts of a path by value: a path whose address they knew would have to stay in memory.
ACCURAY_NOINLINE inline TextureValue texture_value(const SceneView& scene, uint32_t texture, TexturePoint p) {
  const Tagged record = scene.textures[texture];
  return dispatch(Textures{}, record.tag,
                  [&](auto type) { return scene.as<typename decltype(type)::type>(record).value(scene, p); });
}

// Reflectance of a textured spectrum: the texture's colour times the record's scale, held within [0, 1], as a smooth
// spectrum (Jakob and Hanika 2019).
ACCURAY_NOINLINE inline Spectrum textured_reflectance(const SceneView& scene, const SpectrumRecord& s, TexturePoint p,
                                                      Wavelengths wl) {
  const TextureValue rgb = texture_value(scene, s.table, p) * s.scale;
  const float r = rgb_lookup::clamp_unit(rgb[0]);
  const float g = rgb_lookup::clamp_unit(rgb[1]);
  const float b = rgb_lookup::clamp_unit(rgb[2]);
  if (r == g && g == b) return lanes(r);
  const Sigmoid c = rgb_coefficients(scene.rgb, r, g, b);
  return evaluate({SpectrumForm::sigmoid, 1.0f, c.c0, c.c1, c.c2, 0, 0, 0.0f}, scene.tables, wl);
}

// A textured number, held within its parameter's range.
ACCURAY_NOINLINE inline float textured_real(const SceneView& scene, const RealRef& ref, TexturePoint p) {
  const TextureValue value = texture_value(scene, ref.texture, p);
  return min(max(ref.low, value[static_cast<int>(ref.channel)] * ref.value), ref.high);
}

}  // namespace accuray
