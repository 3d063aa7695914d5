// A perfectly smooth metal: a mirror with the exact Fresnel reflectance of its complex index.
#pragma once

#include "kernels/bsdf/bsdf.h"
#include "kernels/bsdf/fresnel.h"

namespace accuray {

struct ConductorAt {
  Spectrum eta, k;

  static constexpr bool delta_only = true;

  Spectrum eval(Vec3, Vec3) const { return lanes(0.0f); }
  float pdf(Vec3, Vec3) const { return 0.0f; }
  BsdfSample sample(Vec3 wo, float, Vec2) const {
    if (wo.z == 0.0f) return no_sample();
    return {{-wo.x, -wo.y, wo.z}, fresnel_conductor(abs(wo.z), eta, k), 0.0f, lobe_specular, 1.0f};
  }
};

struct Conductor {
  SpectrumRef eta, k;

  static constexpr const char* name = "conductor";
  static constexpr const char* doc = "A perfectly smooth metal with the exact Fresnel reflectance, in vacuum or air.";
  static constexpr Keeps keeps{.reciprocal = true, .energy_conserving = true};
  static constexpr auto params() {
    return param_list(Param{.name = "metal",
                            .kind = Kind::text,
                            .doc = "Named metal with measured index: Au, Ag, Cu, Al, Fe, Ti, Cr, Ni, W, Pt, ..., or "
                                   "perfect (reflects all).",
                            .group = "index:metal"},
                      Param{.name = "eta",
                            .kind = Kind::spectrum,
                            .doc = "Real part of the refractive index.",
                            .low = 0,
                            .unit = "1",
                            .role = "index",
                            .group = "index:eta_k",
                            .animatable = true,
                            .member = ACCURAY_OFFSET_OF(Conductor, eta)},
                      Param{.name = "k",
                            .kind = Kind::spectrum,
                            .doc = "Imaginary part of the refractive index.",
                            .low = 0,
                            .unit = "1",
                            .role = "index",
                            .group = "index:eta_k",
                            .animatable = true,
                            .member = ACCURAY_OFFSET_OF(Conductor, k)});
  }
  ConductorAt at(const ShadingPoint& p) const { return {p.spectrum(eta), p.spectrum(k)}; }
};

}  // namespace accuray
