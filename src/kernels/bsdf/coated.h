// A clear or coloured layer of varnish, lacquer or water on another material: a dielectric interface, and light that
// goes between it and the base any number of times.
//
// The layer is so thin that light leaves it where it came in. Values are those of random walks (coat_walk.h), right in
// expectation; the density is a guess (coat_density.h).
#pragma once

#include "kernels/bsdf/coat_density.h"
#include "kernels/bsdf/coat_walk.h"
#include "kernels/bsdf/recoated.h"

namespace accuray {

struct CoatedAt : CoatLayer {
  bool is_delta() const { return upper_is_delta() && !twice; }

  Spectrum eval(Vec3 wo, Vec3 wi) const {
    if (wo.z == 0.0f || wi.z == 0.0f) return lanes(0.0f);
    if (is_bare(wo)) return coat_lobes(*this, false, wo, wi).value;
    if (is_blocked(wo, wi)) return lanes(0.0f);
    if (twice) [[unlikely]] {
      const Spectrum below = below_eval(*this, wo, wi);
      return wo.z < 0.0f || upper_is_delta() ? below : below + coat_eval(*this, wo, wi);
    }
    return coat_eval(*this, wo, wi);
  }
  float pdf(Vec3 wo, Vec3 wi) const {
    if (wo.z == 0.0f || wi.z == 0.0f || is_delta()) return 0.0f;
    if (is_bare(wo)) return coat_lobes(*this, false, wo, wi).pdf[0];
    return twice ? pdf_twice(wo, wi) : coat_pdf(*this, wo, wi);
  }
  BsdfSample sample(Vec3 wo, float u_lobe, Vec2 u) const {
    if (wo.z == 0.0f) return no_sample();
    if (is_bare(wo)) return coat_event(*this, false, wo, {u.x, u.y, u_lobe});
    BsdfSample s = twice ? below_sample(*this, wo, u_lobe, u) : coat_sample(*this, wo, u_lobe, u);
    if (is_black(s.weight)) return s;
    const bool crosses = (s.wi.z > 0.0f) != (wo.z > 0.0f);
    if (crosses) {
      s.lobe |= lobe_transmission;
    } else {
      s.eta_scale = 1.0f;
    }
    if ((s.lobe & lobe_specular) == 0) {
      s.lobe |= lobe;
      s.pdf = twice ? pdf_twice(wo, s.wi) : coat_pdf(*this, wo, s.wi);
    }
    return s;
  }

 private:
  bool upper_is_delta() const { return top.is_delta() && base.is_delta(); }
  // The back of an opaque base has no layer before it.
  bool is_bare(Vec3 wo) const { return wo.z < 0.0f && !base.transmits(); }
  bool is_blocked(Vec3 wo, Vec3 wi) const { return (wo.z > 0.0f) != (wi.z > 0.0f) && (twice || !base.transmits()); }
  float pdf_twice(Vec3 wo, Vec3 wi) const {
    if (is_blocked(wo, wi)) return 0.0f;
    return below_pdf(*this, wo, wi, wo.z < 0.0f || upper_is_delta() ? 0.0f : coat_pdf(*this, wo, wi));
  }
};

struct Coated {
  Tagged base;
  RealRef ior;
  SpectrumRef transmission_color;
  InterfaceParameters interface;

  static constexpr uint32_t tag = Bases::size;  // it follows them in the list
  static constexpr const char* name = "coated";
  static constexpr const char* doc =
      "A thin layer of varnish, lacquer or water on the front of another material, with all reflections between its "
      "surface and the base.";
  static constexpr Keeps keeps{.reciprocal = true, .energy_conserving = true, .stochastic = true};
  static constexpr auto params() {
    return joined(
        param_list(
            Param{.name = "base",
                  .kind = Kind::reference,
                  .doc = "Material under the layer, without emission, opacity, normal or bump map, which belong to the "
                         "coat. It may be a coated diffuse one.",
                  .role = "material",
                  .required = true,
                  .member = ACCURAY_OFFSET_OF(Coated, base)},
            Param{.name = "ior",
                  .kind = Kind::real,
                  .doc =
                      "Index of the layer relative to what is before it, or absolute if the base has a priority. One "
                      "number: between parallel faces light is not dispersed.",
                  .preset = "1.5",
                  .low = 1,
                  .high = 3,
                  .unit = "1",
                  .texturable = true,
                  .animatable = true,
                  .member = ACCURAY_OFFSET_OF(Coated, ior)},
            reflectance_param(
                "transmission_color",
                "Share of the light that is left after crossing the layer straight; of slanted ways, which are "
                "longer, less is left.",
                "1", ACCURAY_OFFSET_OF(Coated, transmission_color))),
        InterfaceParameters::params(ACCURAY_OFFSET_OF(Coated, interface)));
  }
  bool oriented() const { return interface.oriented(); }

  CoatedAt at(ShadingPoint p) const {
    const Spectrum index = lanes(p.real(ior));
    const Spectrum share = p.spectrum(transmission_color);
    CoatedAt at;
    at.top = interface.at(p, index / p.exterior);
    at.share = share;
    at.clear = LayerShare::is_clear(share);
    at.seed = p.seed;
    at.twice = base.tag == tag;
    // The layer lies before the base, but not before the back of an opaque one.
    if (!p.behind || base_transmits(base.tag)) p.exterior = index;
    if (at.twice) [[unlikely]] {
      set_below(p, index, at);
    } else {
      at.base.set(base, p);
    }
    at.lobe = at.twice || (at.base.lobe() & lobe_diffuse) != 0 ? lobe_diffuse : lobe_glossy;
    return at;
  }

 private:
  ACCURAY_NOINLINE void set_below(const ShadingPoint& p, Spectrum index, CoatedAt& at) const {
    const Coated& under = p.scene.as<Coated>(base);
    at.base.set(under.interface.at(p, lanes(p.real(under.ior)) / index));
    at.lower_share = p.spectrum(under.transmission_color);
    at.lower_clear = LayerShare::is_clear(at.lower_share);
    const DiffuseAt matte = p.scene.as<Diffuse>(under.base).at(p);
    at.matte_reflectance = matte.reflectance;
    at.matte_roughness = matte.roughness;
  }
};

}  // namespace accuray
