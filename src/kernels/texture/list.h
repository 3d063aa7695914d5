// All textures, and what parameters read from them. A new texture is a header beside these and a word here.
#pragma once

#include "kernels/dispatch.h"
#include "kernels/texture/checker.h"
#include "kernels/texture/gradient.h"
#include "kernels/texture/image.h"
#include "kernels/texture/marble.h"
#include "kernels/texture/noise.h"
#include "kernels/texture/vertex_color.h"
#include "kernels/texture/wood.h"

namespace accuray {

using Textures = TypeList<ImageTexture, CheckerTexture, GradientTexture, NoiseTexture, WoodTexture, MarbleTexture,
                          VertexColorTexture>;

// Never inlined: scenes without textures shall not carry the code of all of them through every BSDF. Such functions
// take parts of a path by value: a path whose address they knew would have to stay in memory.
ACCURAY_NOINLINE inline TextureValue texture_value(const SceneView& scene, uint32_t texture, TexturePoint p) {
  const Tagged record = scene.textures[texture];
  return dispatch(Textures{}, record.tag,
                  [&](auto type) { return scene.as<typename decltype(type)::type>(record).value(scene, p); });
}

// The smooth spectrum of a colour within [0, 1] (Jakob and Hanika 2019).
inline Spectrum upsampled(const SceneView& scene, float r, float g, float b, const Wavelengths& wl) {
  if (r == g && g == b) return lanes(r);
  const Sigmoid c = rgb_coefficients(scene.rgb, r, g, b);
  return evaluate({SpectrumForm::sigmoid, 1.0f, c.c0, c.c1, c.c2, 0, 0, 0.0f}, scene.tables, wl);
}

// Reflectance of a texture: its colour times the record's scale, held within [0, 1].
inline Spectrum textured_reflectance(const SceneView& scene, const SpectrumRecord& s, const TexturePoint& p,
                                     const Wavelengths& wl) {
  const TextureValue rgb = texture_value(scene, s.table, p) * s.scale;
  return upsampled(scene, rgb_lookup::clamp_unit(rgb[0]), rgb_lookup::clamp_unit(rgb[1]),
                   rgb_lookup::clamp_unit(rgb[2]), wl);
}

// Emission of a texture: a light of its colour times the record's scale under the record's white, as the lowering
// makes one of an RGB triple, from the sigmoid half way up (Jakob and Hanika 2019, section 5). Below 0 is dark.
inline Spectrum textured_emission(const SceneView& scene, const SpectrumRecord& s, const TexturePoint& p,
                                  const Wavelengths& wl) {
  const TextureValue rgb = max(texture_value(scene, s.count, p), lanes(0.0f));
  const float largest = max(rgb[0], max(rgb[1], rgb[2]));
  if (!(largest > 0.0f)) return lanes(0.0f);
  const float part = 0.5f / largest;
  const Spectrum colour = upsampled(scene, rgb[0] * part, rgb[1] * part, rgb[2] * part, wl);
  return colour * lookup(scene.tables + s.table, wl) * (2.0f * largest * s.scale);
}

// Index of refraction of a texture: one of its channels as a number, at all wavelengths.
inline Spectrum textured_index(const SceneView& scene, const SpectrumRecord& s, const TexturePoint& p) {
  const TextureValue value = texture_value(scene, s.table, p);
  return lanes(min(max(s.c0, value[static_cast<int>(s.count)] * s.scale), s.c1));
}

// A spectrum that a texture gives.
ACCURAY_NOINLINE inline Spectrum textured_spectrum(const SceneView& scene, const SpectrumRecord& s, TexturePoint p,
                                                   Wavelengths wl) {
  if (s.form == SpectrumForm::textured_emission) return textured_emission(scene, s, p, wl);
  if (s.form == SpectrumForm::textured_index) return textured_index(scene, s, p);
  return textured_reflectance(scene, s, p, wl);
}

// A textured number, held within its parameter's range.
ACCURAY_NOINLINE inline float textured_real(const SceneView& scene, const RealRef& ref, TexturePoint p) {
  const TextureValue value = texture_value(scene, ref.texture, p);
  return min(max(ref.low, value[static_cast<int>(ref.channel)] * ref.value), ref.high);
}

}  // namespace accuray
