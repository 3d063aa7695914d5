// An interface between two transparent media: exact Fresnel, Snell and total internal reflection, on the surface itself
// where it is smooth and on its facets where it is rough (rough_interface.h).
//
// Reflection is chosen with the mean of the lanes' reflectances, which is the balance heuristic over which wavelength
// might have been the hero (Wilkie et al. 2014, eq. 9): no lane's weight exceeds 4.
#pragma once

#include "kernels/bsdf/rough_interface.h"
#include "kernels/bsdf/rough_params.h"

namespace accuray {

struct DielectricAt {
  RoughInterface rough;

  static constexpr uint32_t lobe = lobe_glossy;
  // Facets of an interface that hardly refracts change nothing, and their half vectors are lost in rounding.
  bool is_delta() const { return rough.facets.is_smooth() || abs(rough.ior[0] - 1.0f) < smallest_step; }

  BsdfLobes lobes(Vec3 wo, Vec3 wi) const {
    return is_delta() ? BsdfLobes{lanes(0.0f), lanes(0.0f)} : rough.lobes(wo, wi);
  }
  Spectrum eval(Vec3 wo, Vec3 wi) const { return lobes(wo, wi).value; }
  float pdf(Vec3 wo, Vec3 wi) const { return lobes(wo, wi).pdf[0]; }

  BsdfSample sample(Vec3 wo, float u_lobe, Vec2 u) const {
    if (wo.z == 0.0f) return no_sample();
    return is_delta() ? smooth_sample(wo, u_lobe) : rough.sample(wo, u_lobe, u);
  }

 private:
  static constexpr float smallest_step = 2e-3f;

  BsdfSample smooth_sample(Vec3 wo, float u_lobe) const {
    const float cos_o = abs(wo.z);
    const Spectrum eta = wo.z > 0.0f ? rough.ior : 1.0f / rough.ior;
    const Spectrum reflectance = rough.reflectance(cos_o, wo.z > 0.0f);
    const float chance = chance_for_all(reflectance, rough.hero_only);
    if (u_lobe < chance) return mirror_sample(wo, reflectance / chance);
    // Snell's law for the hero; without dispersion its direction is everyone's.
    const float e = eta[0];
    const float sin2_t = (1.0f - cos_o * cos_o) / (e * e);
    if (sin2_t >= 1.0f) return no_sample();
    const float cos_t = sqrt(1.0f - sin2_t);
    const Vec3 wi = {-wo.x / e, -wo.y / e, wo.z > 0.0f ? -cos_t : cos_t};
    const Spectrum weight = (1.0f - reflectance) / ((1.0f - chance) * eta * eta);
    const uint32_t way = lobe_specular | lobe_transmission | (rough.disperses ? lobe_disperses : 0u);
    return {wi, weight, 0.0f, way, e * e};
  }
};

// What interfaces are described by besides the indices on both sides.
struct InterfaceParameters {
  RealRef roughness, anisotropy;
  uint32_t compensate;
  RealRef film_thickness;
  SpectrumRef film_ior;

  // `member`: offset of these in the BSDF's struct.
  static constexpr auto params(uint32_t member) {
    return joined(param_list(roughness_param(member + ACCURAY_OFFSET_OF(InterfaceParameters, roughness)),
                             anisotropy_param(member + ACCURAY_OFFSET_OF(InterfaceParameters, anisotropy)),
                             compensate_param(member + ACCURAY_OFFSET_OF(InterfaceParameters, compensate))),
                  film_params(member + ACCURAY_OFFSET_OF(InterfaceParameters, film_thickness),
                              member + ACCURAY_OFFSET_OF(InterfaceParameters, film_ior)));
  }
  bool oriented() const { return is_stretched(anisotropy); }
  // `eta`: index behind the interface over the one before it.
  DielectricAt at(const ShadingPoint& p, Spectrum eta) const {
    const bool disperses = eta[0] != eta[1] || eta[0] != eta[2] || eta[0] != eta[3];
    const FacetsAt at = FacetsAt::of(p, roughness, anisotropy, compensate);
    const FilmAt film = FilmAt::of(p, film_thickness, film_ior);
    const bool even = at.facets.is_smooth() || !film.exists();
    return {{eta, disperses, p.wl.hero_only, at.facets, at.place, film,
             even ? lanes(1.0f) : film_on_diffuse_light(film, eta)}};
  }
};

struct Dielectric {
  SpectrumRef ior;
  InterfaceParameters interface;

  static constexpr const char* name = "dielectric";
  static constexpr const char* doc =
      "A surface of glass, water and the like, polished or frosted: exact Fresnel reflection and refraction with "
      "dispersion, and the colours of a thin film on it.";
  static constexpr bool transmits = true;
  static constexpr Keeps keeps{.exact_pdf = true, .reciprocal = true, .energy_conserving = true};
  static constexpr auto params() {
    return joined(
        param_list(
            index_param("ior",
                        "Index behind the surface relative to the index before it, or absolute if there is a "
                        "priority: a number, a named glass (N-BK7, SF11, water_20C, diamond, ...), Sellmeier or "
                        "Cauchy coefficients, or a table.",
                        "1.5", ACCURAY_OFFSET_OF(Dielectric, ior)),
            Param{.name = "transmission_color",
                  .kind = Kind::spectrum,
                  .doc =
                      "Share of the light that is left after transmission_depth inside the body, which must be closed; "
                      "without a depth after each crossing of the surface.",
                  .low = 0,
                  .high = 1,
                  .unit = "1",
                  .role = "reflectance",
                  .untextured = "it is the colour of the body's inside, which no point of its surface decides",
                  .animatable = true},
            Param{.name = "transmission_depth",
                  .kind = Kind::real,
                  .doc = "Way inside the body after which transmission_color is left.",
                  .low = 1e-12,
                  .unit = "m",
                  .untextured = "it belongs to the body's inside, which no point of its surface decides",
                  .animatable = true},
            Param{.name = "priority",
                  .kind = Kind::integer,
                  .doc = "Of overlapping bodies the one with the highest priority fills the place. With 0 the "
                         "surface is an interface by itself, and ior relative to whatever is around it.",
                  .preset = "0",
                  .low = 0,
                  .high = 1e6}),
        InterfaceParameters::params(ACCURAY_OFFSET_OF(Dielectric, interface)));
  }
  bool oriented() const { return interface.oriented(); }
  DielectricAt at(const ShadingPoint& p) const { return interface.at(p, p.spectrum(ior) / p.exterior); }
};

}  // namespace accuray
