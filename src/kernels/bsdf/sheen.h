// Fuzz: velvet, peach skin, dust. Fibres that stand on end light up towards the edge (Estevez and Kulla 2017).
//
// With the facets' density D(m) = (2 + 1/a) sin(m)^(1/a) / (2 pi) and, in place of masking, the term of Ashikhmin and
// Premoze (2007), V = 1 / (4 (cos_o + cos_i - cos_o cos_i)), f = D V is reciprocal. Where it is narrow it gives back
// more than there was next to grazing angles, so it is divided by the larger of the two directions' albedos where that
// is above 1: the departure from the paper that makes it keep energy. tools/make_sheen_table.py tabulates albedos
// before and after.
#pragma once

#include "kernels/bsdf/bsdf.h"
#include "kernels/bsdf/energy.h"
#include "kernels/bsdf/sheen_data.h"
#include "kernels/sampling/warp.h"

namespace accuray {

// A place in the tables: nodes are evenly spread over the root of what alpha has above the least, and over the root of
// the cosine.
struct SheenPlace {
  TablePlace<sheen_alphas> alpha;

  static float alpha_of(float roughness) { return max(roughness, sheen_least_alpha); }
  static SheenPlace of(float roughness) {
    const float above = (alpha_of(roughness) - sheen_least_alpha) / (1.0f - sheen_least_alpha);
    return {TablePlace<sheen_alphas>::at(sqrt(above))};
  }
  float value(const SheenGrid& grid, float cosine) const {
    const auto place = TablePlace<sheen_cosines>::at(sqrt(cosine));
    const uint16_t* low = grid.value[alpha.first];
    const uint16_t* high = grid.value[alpha.first + 1];
    return sheen_step * between(between(low[place.first], low[place.first + 1], place.fraction),
                                between(high[place.first], high[place.first + 1], place.fraction), alpha.fraction);
  }
};

// Share of the light from a direction that white fuzz reflects.
inline float sheen_albedo(float cosine, float roughness) {
  return min(SheenPlace::of(roughness).value(sheen_table.albedo, cosine), 1.0f);
}

struct SheenAt {
  Spectrum color;
  float roughness;

  static constexpr uint32_t lobe = lobe_diffuse;
  static constexpr bool is_delta() { return false; }

  Spectrum eval(Vec3 wo, Vec3 wi) const {
    if (!(wo.z * wi.z > 0.0f)) return lanes(0.0f);
    return color * white(wo, wi);
  }
  float pdf(Vec3 wo, Vec3 wi) const { return wo.z * wi.z > 0.0f ? uniform_hemisphere_pdf : 0.0f; }
  // The lobe covers the hemisphere: no weight exceeds (2 + 1/a) / 4.
  BsdfSample sample(Vec3 wo, float, Vec2 u) const {
    Vec3 wi = square_to_hemisphere(u);
    if (wo.z == 0.0f || wi.z == 0.0f) return no_sample();
    if (wo.z < 0.0f) wi.z = -wi.z;
    return {wi, color * (white(wo, wi) / uniform_hemisphere_pdf), uniform_hemisphere_pdf, lobe_diffuse, 1.0f};
  }

 private:
  float white(Vec3 wo, Vec3 wi) const {
    const float cos_o = min(abs(wo.z), 1.0f);
    const float cos_i = min(abs(wi.z), 1.0f);
    const float inverse = 1.0f / SheenPlace::alpha_of(roughness);
    const Vec3 half = wo + wi;
    const float sin2 = min(fma(half.x, half.x, half.y * half.y) / length_squared(half), 1.0f);
    const float steep = static_cast<float>(pow(static_cast<double>(sin2), 0.5 * static_cast<double>(inverse)));
    const float density = (2.0f + inverse) * (0.5f * inv_pi) * steep;
    const SheenPlace place = SheenPlace::of(roughness);
    const float most = max(place.value(sheen_table.bare, cos_o), place.value(sheen_table.bare, cos_i));
    return density * cos_i / (4.0f * fma(cos_o, 1.0f - cos_i, cos_i) * max(most, 1.0f));
  }
};

struct Sheen {
  SpectrumRef color;
  RealRef roughness;

  static constexpr const char* name = "sheen";
  static constexpr const char* doc =
      "Fuzz, the same on both sides: fibres that stand on end, bright at the edge of a shape and where light comes "
      "from "
      "behind it. What they do not reflect is absorbed.";
  static constexpr Keeps keeps{.exact_pdf = true, .reciprocal = true, .energy_conserving = true};
  static constexpr auto params() {
    return param_list(reflectance_param("color", "Share of the light that meets the fibres that they reflect.", "1",
                                        ACCURAY_OFFSET_OF(Sheen, color)),
                      share_param("roughness",
                                  "How far the fibres lean: a thin bright edge near 0, dusty at 1. Below 0.05 it stays "
                                  "as it is there.",
                                  "0.5", ACCURAY_OFFSET_OF(Sheen, roughness)));
  }
  SheenAt at(const ShadingPoint& p) const { return {p.spectrum(color), p.real(roughness)}; }
};

}  // namespace accuray
