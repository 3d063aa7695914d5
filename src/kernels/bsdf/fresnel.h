// Exact Fresnel reflectances for unpolarised light: the mean of the s and p reflectances, four wavelengths at once.
#pragma once

#include "kernels/spectrum/wavelengths.h"

namespace accuray {

// Interface between two dielectrics: cos_i >= 0 on the side of the ray, eta = index beyond / index on the ray's side.
// 1 on total internal reflection. Born and Wolf 1999, section 1.5.2.
inline f32x4 fresnel_dielectric(float cos_i, f32x4 eta) {
  const f32x4 sin2_t = (1.0f - cos_i * cos_i) / (eta * eta);
  const f32x4 cos_t = sqrt(max(lanes(1.0f) - sin2_t, lanes(0.0f)));
  const f32x4 s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  const f32x4 p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  f32x4 r = (s * s + p * p) * 0.5f;
  for (int k = 0; k < 4; ++k) {
    if (sin2_t[k] >= 1.0f) r[k] = 1.0f;
  }
  return r;
}

// Interface from vacuum to a conductor of complex index eta + i k. Born and Wolf 1999, section 14.2, in real
// arithmetic. eta = 0 reflects everything.
inline f32x4 fresnel_conductor(float cos_i, f32x4 eta, f32x4 k) {
  const float cos2 = cos_i * cos_i;
  const float sin2 = 1.0f - cos2;
  const f32x4 e2 = eta * eta;
  const f32x4 k2 = k * k;
  const f32x4 difference = e2 - k2 - sin2;
  const f32x4 modulus = sqrt(fma(difference, difference, 4.0f * e2 * k2));
  const f32x4 a = sqrt(max((modulus + difference) * 0.5f, lanes(0.0f)));
  const f32x4 s_plus = modulus + cos2;
  const f32x4 s_cross = 2.0f * cos_i * a;
  const f32x4 s = (s_plus - s_cross) / (s_plus + s_cross);
  const f32x4 p_plus = cos2 * modulus + sin2 * sin2;
  const f32x4 p_cross = s_cross * sin2;
  const f32x4 p = s * (p_plus - p_cross) / (p_plus + p_cross);
  return (s + p) * 0.5f;
}

}  // namespace accuray
