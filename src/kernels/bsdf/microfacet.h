// The microfacets of a rough surface: GGX with Smith's masking, round or stretched along the tangents (Trowbridge and
// Reitz 1975; Walter et al. 2007; Heitz 2014).
//
// Conventions
//   - Directions lie on the side of +z here; what comes from below is turned over first, which a distribution that is
//     symmetric in x and in y does not notice.
//   - `root` is |cos| sqrt(1 + a^2 tan^2): Smith's masking is G1 = 2 cos / (cos + root), and both forms of G2 become
//     sums of products that survive grazing angles.
#pragma once

#include "kernels/math/functions.h"
#include "kernels/math/vec.h"

namespace accuray {

// Rougher than this the facets are a distribution, below it a mirror: a lobe of half a milliradian is narrower than
// what directions in single precision tell apart.
constexpr float smallest_alpha = 1e-3f;
// Of the width across to that along.
constexpr float smallest_ratio = 0.05f;

struct Ggx {
  float alpha_x, alpha_y;  // widths of the slopes; 0 for a smooth surface

  // alpha = roughness^2 (Burley 2012), stretched so that the mean square slope stays (OpenPBR 2024).
  static Ggx of(float roughness, float anisotropy) {
    const float alpha = roughness * roughness;
    if (alpha < smallest_alpha) return {0.0f, 0.0f};
    const float ratio = max(1.0f - anisotropy, smallest_ratio);
    const float along = alpha * sqrt(2.0f / fma(ratio, ratio, 1.0f));
    return {along, max(ratio * along, smallest_alpha)};
  }
  bool is_smooth() const { return alpha_x == 0.0f; }

  float root(Vec3 w) const {
    const float x = alpha_x * w.x;
    const float y = alpha_y * w.y;
    return sqrt(fma(x, x, fma(y, y, w.z * w.z)));
  }
  // Facets per solid angle and area around the direction of m, which may have any length: D(m / |m|).
  float density(Vec3 m) const {
    const float x = m.x / alpha_x;
    const float y = m.y / alpha_y;
    const float stretched = fma(x, x, fma(y, y, m.z * m.z)) / length_squared(m);
    return inv_pi / (alpha_x * alpha_y * stretched * stretched);
  }
  // A facet seen from wo, with the density G1(wo) D(m) wo.m / wo.z: a reflection of the hemisphere of the stretched
  // configuration (Dupuy and Benyoub 2023).
  Vec3 sample_visible(Vec3 wo, Vec2 u) const {
    const Vec3 w = normalize({alpha_x * wo.x, alpha_y * wo.y, wo.z});
    const float z = fma(1.0f - u.y, 1.0f + w.z, -w.z);
    const float r = sqrt(max(0.0f, 1.0f - z * z));
    const SinCos phi = sincos(2.0f * pi * u.x);
    const Vec3 m = {fma(r, phi.cos, w.x), fma(r, phi.sin, w.y), z + w.z};
    return normalize({alpha_x * m.x, alpha_y * m.y, max(m.z, 0x1p-100f)});
  }
};

// G2(wo, wi) / (cos_o cos_i) by masking and shadowing that know of each other's height (Heitz 2014, eq. 99), and by
// such that do not (eq. 98).
inline float correlated_masking(float cos_o, float root_o, float cos_i, float root_i) {
  return 2.0f / (cos_o * root_i + cos_i * root_o);
}
inline float separable_masking(float cos_o, float root_o, float cos_i, float root_i) {
  return 4.0f / ((cos_o + root_o) * (cos_i + root_i));
}

}  // namespace accuray
