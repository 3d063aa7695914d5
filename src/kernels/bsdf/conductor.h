// A metal: a mirror where it is smooth, GGX facets where it is rough, with Fresnel's reflectance on each facet.
//
// Light that scatters more than once among the facets is given back by a second lobe (energy.h), which meets the metal
// at least twice: its colour is F^2 E / (1 - F (1 - E)) for the mean reflectance F and the mean share E of light that
// one scattering lets go (Kulla and Conty 2017; Hill 2018).
#pragma once

#include "kernels/bsdf/energy.h"
#include "kernels/bsdf/metal.h"
#include "kernels/bsdf/rough_params.h"
#include "kernels/sampling/warp.h"

namespace accuray {

struct ConductorAt {
  // Its last bytes are shared: on GPUs there is little room for what lies under a coat.
  [[no_unique_address]] MetalAt metal;
  Ggx facets;
  MetalLoss loss;

  static constexpr uint32_t lobe = lobe_glossy;
  bool is_delta() const { return facets.is_smooth(); }

  struct Lobes {
    Spectrum value;
    float pdf;
  };

  Lobes lobes(Vec3 wo, Vec3 wi) const { return is_delta() ? Lobes{lanes(0.0f), 0.0f} : facet_lobes(wo, wi); }
  Spectrum eval(Vec3 wo, Vec3 wi) const { return lobes(wo, wi).value; }
  float pdf(Vec3 wo, Vec3 wi) const { return lobes(wo, wi).pdf; }

  BsdfSample sample(Vec3 wo, float u_lobe, Vec2 u) const {
    if (wo.z == 0.0f) return no_sample();
    if (is_delta()) return mirror_sample(wo, metal.reflectance(abs(wo.z)));
    const Vec3 above = {wo.x, wo.y, abs(wo.z)};
    Vec3 wi;
    if (u_lobe < loss.at(above.z)) {
      wi = square_to_hemisphere(u);
    } else {
      const Vec3 m = facets.sample_visible(above, u);
      wi = fma(2.0f * dot(above, m), m, -above);
    }
    if (wi.z <= 0.0f) return no_sample();
    if (wo.z < 0.0f) wi.z = -wi.z;
    const Lobes both = facet_lobes(wo, wi);
    return {wi, both.value / both.pdf, both.pdf, lobe_glossy, 1.0f};
  }

 private:
  // Value and density of the facets' lobe and the one of what they lose; not inlined, like that of interfaces.
  ACCURAY_NOINLINE Lobes facet_lobes(Vec3 wo, Vec3 wi) const {
    if (wo.z == 0.0f || wi.z == 0.0f || (wo.z > 0.0f) != (wi.z > 0.0f)) return {lanes(0.0f), 0.0f};
    const Vec3 half = wo + wi;
    const float cos_o = abs(wo.z);
    const float cos_i = abs(wi.z);
    const float root_o = facets.root(wo);
    const float root_i = facets.root(wi);
    const float density = facets.density(half);
    const float masking = loss.separable ? separable_masking(cos_o, root_o, cos_i, root_i)
                                         : correlated_masking(cos_o, root_o, cos_i, root_i);
    const Spectrum once = metal.reflectance(min(0.5f * length(half), 1.0f)) * (0.25f * density * masking * cos_i);
    const float pdf_once = 0.5f * density / (cos_o + root_o);
    const float lost = loss.at(cos_o);
    if (lost == 0.0f) return {once, pdf_once};
    const float mean = loss.mean();
    const Spectrum f = metal.mean();
    const Spectrum colour = f * f * (1.0f - mean) / (1.0f - f * mean);
    const Spectrum more = colour * (lost * loss.at(cos_i) * inv_pi / mean * cos_i);
    return {once + more, between(pdf_once, uniform_hemisphere_pdf, lost)};
  }
};

struct Conductor {
  SpectrumRef eta, k;
  SpectrumRef reflectance, edge_tint;
  RealRef roughness, anisotropy;
  uint32_t separable;
  uint32_t compensate;
  RealRef film_thickness;
  SpectrumRef film_ior;

  static constexpr const char* name = "conductor";
  static constexpr const char* doc =
      "A metal, polished or rough, bare or with a thin film on it: GGX facets with the exact Fresnel reflectance.";
  static constexpr Keeps keeps{.exact_pdf = true, .reciprocal = true, .energy_conserving = true};
  static constexpr auto params() {
    return joined(
        reflectance_params(),
        joined(param_list(roughness_param(ACCURAY_OFFSET_OF(Conductor, roughness)),
                          anisotropy_param(ACCURAY_OFFSET_OF(Conductor, anisotropy)),
                          Param{.name = "masking",
                                .kind = Kind::choice,
                                .doc = "Whether facets' masking and shadowing know of their common height.",
                                .preset = "\"correlated\"",
                                .choices = "correlated|separable",
                                .member = ACCURAY_OFFSET_OF(Conductor, separable)},
                          compensate_param(ACCURAY_OFFSET_OF(Conductor, compensate))),
               film_params(ACCURAY_OFFSET_OF(Conductor, film_thickness), ACCURAY_OFFSET_OF(Conductor, film_ior))));
  }
  bool oriented() const { return is_stretched(anisotropy); }
  ConductorAt at(const ShadingPoint& p) const {
    const FilmAt film = FilmAt::of(p, film_thickness, film_ior);
    const MetalAt metal = reflectance.index == none
                              ? MetalAt::of_index(p.spectrum(eta) / p.exterior, p.spectrum(k) / p.exterior, film)
                              : coloured(p.spectrum(reflectance), p.spectrum(edge_tint), film);
    const FacetsAt at = FacetsAt::of(p, roughness, anisotropy, compensate);
    return {metal, at.facets, {at.place, separable != 0}};
  }

 private:
  static MetalAt coloured(Spectrum reflectance, Spectrum tint, const FilmAt& film) {
    if (film.exists()) [[unlikely]]
      return MetalAt::of_filmed_colours(reflectance, tint, film);
    return MetalAt::of_colours(reflectance, tint);
  }
  // What is reflected along the normal and beside it.
  static constexpr ParamList<5> reflectance_params() {
    return param_list(
        Param{.name = "metal",
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
              .texturable = true,
              .animatable = true,
              .member = ACCURAY_OFFSET_OF(Conductor, eta)},
        Param{.name = "k",
              .kind = Kind::spectrum,
              .doc = "Imaginary part of the refractive index.",
              .low = 0,
              .unit = "1",
              .role = "index",
              .group = "index:eta_k",
              .texturable = true,
              .animatable = true,
              .member = ACCURAY_OFFSET_OF(Conductor, k)},
        in_group(reflectance_param("reflectance", "Reflectance along the normal, in place of an index.", "",
                                   ACCURAY_OFFSET_OF(Conductor, reflectance)),
                 "index:reflectance"),
        in_group(reflectance_param(
                     "edge_tint",
                     "With reflectance: what the reflectance at 82 degrees is multiplied with, towards the edge.", "1",
                     ACCURAY_OFFSET_OF(Conductor, edge_tint)),
                 "index:reflectance"));
  }
};

}  // namespace accuray
