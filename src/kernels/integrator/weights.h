// What two techniques that find the same light count for each (Veach and Guibas 1995).
#pragma once

#include "kernels/bsdf/bsdf.h"

namespace accuray {

// Share of the first of two techniques: power heuristic with exponent 2 (Veach and Guibas 1995).
inline float mis_weight(float pdf, float other) {
  const float a = pdf * pdf;
  return a / (a + other * other);
}
// The same by lane, for a density that depends on which of them is the hero: a path that refracts goes on with its hero
// alone, and its other half must be the same function of the wavelength.
inline Spectrum mis_weight(float pdf, Spectrum other) { return pdf * pdf / (pdf * pdf + other * other); }

// A BSDF's value towards a light, and the share of the light sample there.
struct LightValue {
  Spectrum value;
  Spectrum weight;
};
template <class BsdfAt>
inline LightValue towards_light(const BsdfAt& bsdf, Vec3 wo, Vec3 wi, float pdf, bool alone) {
  if constexpr (requires { bsdf.lobes(wo, wi); }) {
    const auto both = bsdf.lobes(wo, wi);
    return {both.value, alone ? lanes(1.0f) : lanes(1.0f) * mis_weight(pdf, both.pdf)};
  } else {
    const Spectrum value = bsdf.eval(wo, wi);
    return {value, alone || is_black(value) ? lanes(1.0f) : lanes(mis_weight(pdf, bsdf.pdf(wo, wi)))};
  }
}

}  // namespace accuray
