// Lambert's law: light leaves equally in all directions of the side that it came from.
#pragma once

#include "kernels/bsdf/bsdf.h"
#include "kernels/sampling/warp.h"

namespace accuray {

struct DiffuseAt {
  Spectrum reflectance;

  static constexpr bool delta_only = false;

  Spectrum eval(Vec3 wo, Vec3 wi) const {
    return wo.z * wi.z > 0.0f ? reflectance * (abs(wi.z) * inv_pi) : lanes(0.0f);
  }
  float pdf(Vec3 wo, Vec3 wi) const { return wo.z * wi.z > 0.0f ? cosine_hemisphere_pdf(abs(wi.z)) : 0.0f; }
  BsdfSample sample(Vec3 wo, float, Vec2 u) const {
    Vec3 wi = square_to_cosine_hemisphere(u);
    const float density = cosine_hemisphere_pdf(wi.z);
    if (density == 0.0f) return no_sample();
    if (wo.z < 0.0f) wi.z = -wi.z;
    return {wi, reflectance, density, lobe_diffuse, 1.0f};
  }
};

struct Diffuse {
  SpectrumRef reflectance;

  static constexpr const char* name = "diffuse";
  static constexpr const char* doc = "A perfectly matte surface (Lambert 1760), the same on both sides.";
  static constexpr Keeps keeps{.exact_pdf = true, .reciprocal = true, .energy_conserving = true};
  static constexpr auto params() {
    return param_list(Param{.name = "reflectance",
                            .kind = Kind::spectrum,
                            .doc = "Share of the light that is reflected.",
                            .preset = "0.5",
                            .low = 0,
                            .high = 1,
                            .unit = "1",
                            .role = "reflectance",
                            .texturable = true,
                            .animatable = true,
                            .member = ACCURAY_OFFSET_OF(Diffuse, reflectance)});
  }
  DiffuseAt at(const ShadingPoint& p) const { return {p.spectrum(reflectance)}; }
};

}  // namespace accuray
