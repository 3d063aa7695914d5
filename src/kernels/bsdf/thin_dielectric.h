// A pane: two smooth interfaces so close that light leaves where it came in, with all reflections between them.
//
// With the reflectance R of one interface for unpolarised light, the pane reflects 2 R / (1 + R) and transmits the rest
// (Stokes 1862). That takes every interface as depolarising, as two interfaces apart do here.
#pragma once

#include "kernels/bsdf/bsdf.h"
#include "kernels/bsdf/fresnel.h"

namespace accuray {

struct ThinDielectricAt {
  Spectrum ior;
  Spectrum before;  // index on the front side, where a layer may lie on the pane; 1 behind it
  bool hero_only;

  static constexpr uint32_t lobe = lobe_specular;
  static constexpr bool is_delta() { return true; }

  Spectrum eval(Vec3, Vec3) const { return lanes(0.0f); }
  float pdf(Vec3, Vec3) const { return 0.0f; }

  BsdfSample sample(Vec3 wo, float u_lobe, Vec2) const {
    if (wo.z == 0.0f) return no_sample();
    if (before[0] != 1.0f) [[unlikely]]
      return sample_between(wo, u_lobe);
    const Spectrum r = fresnel_dielectric(abs(wo.z), ior);
    const Spectrum reflectance = 2.0f * r / (1.0f + r);
    const float chance = chance_for_all(reflectance, hero_only);
    if (u_lobe < chance) return mirror_sample(wo, reflectance / chance);
    const Spectrum weight = (1.0f - reflectance) / (1.0f - chance);
    return {-wo, weight, 0.0f, lobe_specular | lobe_transmission, 1.0f};
  }

 private:
  // Between two media, each interface reflects differently and what passes is refracted.
  BsdfSample sample_between(Vec3 wo, float u_lobe) const {
    const float cos_o = abs(wo.z);
    const Spectrum n_o = wo.z > 0.0f ? before : lanes(1.0f);
    const Spectrum n_i = wo.z > 0.0f ? lanes(1.0f) : before;
    const float e = n_i[0] / n_o[0];
    const float sin2_t = (1.0f - cos_o * cos_o) / (e * e);
    if (sin2_t >= 1.0f) return mirror_sample(wo, lanes(1.0f));
    const float cos_t = sqrt(1.0f - sin2_t);
    const Spectrum near = fresnel_dielectric(cos_o, ior / n_o);
    const Spectrum far = fresnel_dielectric(cos_t, ior / n_i);
    const Spectrum through = (1.0f - near) * (1.0f - far) / max(1.0f - near * far, lanes(0x1p-100f));
    const float chance = chance_for_all(1.0f - through, hero_only);
    if (u_lobe < chance) return mirror_sample(wo, (1.0f - through) / chance);
    const Vec3 wi = {-wo.x / e, -wo.y / e, wo.z > 0.0f ? -cos_t : cos_t};
    return {wi, through / ((1.0f - chance) * e * e), 0.0f, lobe_specular | lobe_transmission, e * e};
  }
};

struct ThinDielectric {
  SpectrumRef ior;

  static constexpr const char* name = "thin_dielectric";
  static constexpr const char* doc =
      "A pane of glass or a film of water as one surface: reflects and transmits without refraction, all reflections "
      "inside it included.";
  static constexpr bool transmits = true;
  static constexpr Keeps keeps{.reciprocal = true, .energy_conserving = true};
  static constexpr auto params() {
    return param_list(index_param("ior", "Index of the pane relative to what is around it, as for a dielectric.", "1.5",
                                  ACCURAY_OFFSET_OF(ThinDielectric, ior)));
  }
  ThinDielectricAt at(const ShadingPoint& p) const { return {p.spectrum(ior), p.exterior, p.wl.hero_only}; }
};

}  // namespace accuray
