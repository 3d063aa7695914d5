// A matte surface: Lambert's law where it is smooth, and where it is rough the model of Oren and Nayar in the form that
// loses no energy (EON; Portsmouth, Kutz and Hill 2024).
//
// EON is the sum of light scattered once, by Fujii's form of Oren and Nayar's model, and of what that loses, given back
// in proportion to the loss in both directions. `share` below is the directional albedo of the former for a white
// surface, in closed form.
#pragma once

#include "kernels/bsdf/bsdf.h"
#include "kernels/sampling/warp.h"

namespace accuray {

struct DiffuseAt {
  Spectrum reflectance;
  float roughness;

  static constexpr uint32_t lobe = lobe_diffuse;
  static constexpr bool is_delta() { return false; }

  Spectrum eval(Vec3 wo, Vec3 wi) const {
    if (!(wo.z * wi.z > 0.0f)) return lanes(0.0f);
    return (roughness == 0.0f ? reflectance : rough(wo, wi)) * (abs(wi.z) * inv_pi);
  }
  float pdf(Vec3 wo, Vec3 wi) const {
    const float lambert = wo.z * wi.z > 0.0f ? cosine_hemisphere_pdf(abs(wi.z)) : 0.0f;
    return roughness == 0.0f || lambert == 0.0f ? lambert : rough_pdf(lambert);
  }
  BsdfSample sample(Vec3 wo, float, Vec2 u) const {
    if (roughness > 0.0f) return rough_sample(wo, u);
    Vec3 wi = square_to_cosine_hemisphere(u);
    const float density = cosine_hemisphere_pdf(wi.z);
    if (density == 0.0f) return no_sample();
    if (wo.z < 0.0f) wi.z = -wi.z;
    return {wi, reflectance, density, lobe_diffuse, 1.0f};
  }

 private:
  // Between grazing directions the value grows beyond all bounds. A part of the samples is uniform, so no weight does.
  float uniform_share() const { return 0.5f * roughness; }
  float rough_pdf(float lambert) const { return fma(uniform_share(), uniform_hemisphere_pdf - lambert, lambert); }
  BsdfSample rough_sample(Vec3 wo, Vec2 u) const {
    const float share = uniform_share();
    Vec3 wi = u.x < share ? square_to_hemisphere({u.x / share, u.y})
                          : square_to_cosine_hemisphere({(u.x - share) / (1.0f - share), u.y});
    const float lambert = cosine_hemisphere_pdf(wi.z);
    if (lambert == 0.0f) return no_sample();
    if (wo.z < 0.0f) wi.z = -wi.z;
    const float density = rough_pdf(lambert);
    return {wi, rough(wo, wi) * (lambert / density), density, lobe_diffuse, 1.0f};
  }
  float scale() const { return 1.0f / (1.0f + (0.5f - 2.0f / 3.0f * inv_pi) * roughness); }
  float share(float cosine) const {
    const float sine = sqrt(max(0.0f, 1.0f - cosine * cosine));
    const float g = sine * (acos(cosine) - sine * cosine - 2.0f / 3.0f) +
                    2.0f / 3.0f * sine * cosine * (1.0f + sine + sine * sine) / (1.0f + sine);
    return scale() * (1.0f + roughness * inv_pi * g);
  }
  // pi f, by the paper's equations 14 to 22.
  Spectrum rough(Vec3 wo, Vec3 wi) const {
    const float cos_o = min(abs(wo.z), 1.0f);
    const float cos_i = min(abs(wi.z), 1.0f);
    const float s = fma(wo.x, wi.x, wo.y * wi.y);
    const float once = scale() * (1.0f + roughness * (s > 0.0f ? s / max(cos_o, cos_i) : s));
    const float mean = scale() * (1.0f + (2.0f / 3.0f - 28.0f / 15.0f * inv_pi) * roughness);
    const float lost = max(1.0f - share(cos_o), 0.0f) * max(1.0f - share(cos_i), 0.0f) / (1.0f - mean);
    return reflectance * once + reflectance * reflectance * (mean * lost) / (1.0f - reflectance * (1.0f - mean));
  }
};

struct Diffuse {
  SpectrumRef reflectance;
  RealRef roughness;

  static constexpr const char* name = "diffuse";
  static constexpr const char* doc =
      "A matte surface, the same on both sides: Lambert's (1760) where it is smooth, Oren and Nayar's without their "
      "loss "
      "of energy where it is rough.";
  static constexpr Keeps keeps{.exact_pdf = true, .reciprocal = true, .energy_conserving = true};
  static constexpr auto params() {
    return param_list(
        reflectance_param("reflectance", "Share of the light that is reflected.", "0.5",
                          ACCURAY_OFFSET_OF(Diffuse, reflectance)),
        share_param("roughness",
                    "0 is Lambert's law; 1, like the moon or dry clay, is flatter and brighter at the edge.", "0",
                    ACCURAY_OFFSET_OF(Diffuse, roughness)));
  }
  DiffuseAt at(const ShadingPoint& p) const { return {p.spectrum(reflectance), p.real(roughness)}; }
};

}  // namespace accuray
