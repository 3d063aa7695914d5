// A rough interface of two transparent media: GGX facets that reflect and refract (Walter et al. 2007), and a lobe that
// gives back what the facets lose (energy.h).
//
// Where the index depends on the wavelength the hero's refraction decides the direction of a sample; every lane has a
// half vector of its own there, so values and densities through the interface are lane by lane.
//
// Conventions
//   - Indices are 1 before the surface and `ior` behind it; n_o is that on the side of wo, n_i that on the side of wi.
//   - Values on one side and on the other are sums and products of the same numbers when wo and wi change places, so
//     reciprocity holds to rounding.
#pragma once

#include "kernels/bsdf/bsdf.h"
#include "kernels/bsdf/energy.h"
#include "kernels/bsdf/fresnel.h"
#include "kernels/bsdf/thin_film.h"
#include "kernels/sampling/warp.h"

namespace accuray {

struct RoughInterface {
  Spectrum ior;
  bool disperses;
  bool hero_only;
  Ggx facets;
  EnergyPlace place;
  FilmAt film = {};
  Spectrum film_share = lanes(1.0f);  // of diffuse light passes, relative to the bare interface

  // Of a facet, for light that comes at `cosine` from before it (above) or from behind.
  Spectrum reflectance(float cosine, bool above) const {
    if (film.exists()) [[unlikely]]
      return film_reflectance(film, ior, cosine, above);
    return fresnel_dielectric(cosine, across(above));
  }

  // Not inlined, so that compilers for GPUs have one copy of it to work on.
  ACCURAY_NOINLINE BsdfLobes lobes(Vec3 wo, Vec3 wi) const {
    if (wo.z == 0.0f || wi.z == 0.0f) return {lanes(0.0f), lanes(0.0f)};
    const bool above = wo.z > 0.0f;
    if (!above) {
      wo.z = -wo.z;
      wi.z = -wi.z;
    }
    return wi.z > 0.0f ? reflected(wo, wi, above) : refracted(wo, wi, above);
  }

  BsdfSample sample(Vec3 wo, float u_lobe, Vec2 u) const {
    const Vec3 o = {wo.x, wo.y, abs(wo.z)};
    const bool above = wo.z > 0.0f;
    const Loss lost = lost_from(o.z, above);
    Vec3 wi;
    if (u_lobe < lost.chance) {
      wi = square_to_hemisphere(u);
      if (u_lobe < lost.chance * lost.crossing_chance) wi.z = -wi.z;
    } else {
      wi = facet_sample(o, (u_lobe - lost.chance) / (1.0f - lost.chance), u, above);
    }
    if (wi.z == 0.0f) return no_sample();
    const bool crosses = wi.z < 0.0f;
    if (!above) wi.z = -wi.z;
    const BsdfLobes both = lobes(wo, wi);
    if (both.pdf[0] == 0.0f) return no_sample();
    const float e = crosses ? across(0, above) : 1.0f;
    const uint32_t lobe = lobe_glossy | (crosses ? lobe_transmission | (disperses ? lobe_disperses : 0u) : 0u);
    return {wi, both.value / both.pdf[0], both.pdf[0], lobe, e * e};
  }

 private:
  struct Loss {
    Spectrum share;         // lost from the direction, by lane
    Spectrum crossing;      // part of it that is given back on the other side
    float chance;           // of a sample of the lobe that gives it back
    float crossing_chance;  // of those
  };

  // Index beyond over index on the side of wo.
  float across(int k, bool above) const { return above ? ior[k] : 1.0f / ior[k]; }
  Spectrum across(bool above) const { return above ? ior : 1.0f / ior; }
  // Lanes have one reflectance, not each its own.
  bool even() const { return !disperses && !film.exists(); }
  // What decides for all lanes: their mean while they go together.
  float decision(Spectrum s) const { return chance_for_all(s, even() || hero_only); }
  // Calls fn for each lane that differs and carries something.
  template <class Fn>
  Spectrum by_lane(Fn&& fn) const {
    if (even()) return lanes(fn(0));
    Spectrum result = lanes(0.0f);
    for (int k = 0; k < (hero_only ? 1 : 4); ++k) result[k] = fn(k);
    return result;
  }

  bool is_dense(int k, bool above) const { return (ior[k] < 1.0f) == above; }
  InterfaceLoss loss(int k) const {
    return InterfaceLoss::of(place, min(ior[k], 1.0f), max(ior[k], 1.0f), film_share[k]);
  }

  Loss lost_from(float cosine, bool above) const {
    Loss lost;
    lost.share = by_lane([&](int k) { return loss(k).at(is_dense(k, above), cosine); });
    lost.crossing =
        by_lane([&](int k) { return loss(k).crossing(is_dense(k, above), min(ior[k], 1.0f), max(ior[k], 1.0f)); });
    lost.chance = decision(lost.share);
    lost.crossing_chance = lost.crossing[0];
    if (!even() && lost.chance > 0.0f) lost.crossing_chance = decision(lost.share * lost.crossing) / lost.chance;
    return lost;
  }

  // Direction by way of a visible facet; z = 0 if it fails.
  Vec3 facet_sample(Vec3 o, float u_choice, Vec2 u, bool above) const {
    const Vec3 m = facets.sample_visible(o, u);
    const float cosine = min(dot(o, m), 1.0f);
    Vec3 wi;
    if (u_choice < decision(reflectance(cosine, above))) {
      wi = fma(2.0f * cosine, m, -o);
      return wi.z > 0.0f ? wi : Vec3{0, 0, 0};
    }
    const float e = across(0, above);
    const float sin2_t = (1.0f - cosine * cosine) / (e * e);
    if (sin2_t >= 1.0f) return {0, 0, 0};
    wi = normalize(fma(cosine / e - sqrt(1.0f - sin2_t), m, o * (-1.0f / e)));
    return wi.z < 0.0f ? wi : Vec3{0, 0, 0};
  }

  BsdfLobes reflected(Vec3 wo, Vec3 wi, bool above) const {
    const Vec3 half = wo + wi;
    const float root_o = facets.root(wo);
    const float density = facets.density(half);
    const Spectrum f = reflectance(min(0.5f * length(half), 1.0f), above);
    const float once = 0.25f * density * correlated_masking(wo.z, root_o, wi.z, facets.root(wi)) * wi.z;
    const float pdf_once = 0.5f * density / (wo.z + root_o) * decision(f);
    const Loss lost = lost_from(wo.z, above);
    const float pdf_more = (1.0f - lost.crossing_chance) * uniform_hemisphere_pdf;
    if (lost.chance == 0.0f) return {f * once, lanes(pdf_once)};
    const Spectrum more = by_lane([&](int k) {
      const bool dense = is_dense(k, above);
      const float given_back = lost.share[k] * loss(k).at(dense, wi.z) / loss(k).mean(dense);
      return (1.0f - lost.crossing[k]) * given_back * inv_pi * wi.z;
    });
    return {fma(f, lanes(once), more), lanes(between(pdf_once, pdf_more, lost.chance))};
  }

  // Walter et al. 2007, eq. 21, with the square of n_o taken to the side where radiance is scaled.
  BsdfLobes refracted(Vec3 wo, Vec3 wi, bool above) const {
    const float cos_i = -wi.z;
    const float root_o = facets.root(wo);
    const float masking = correlated_masking(wo.z, root_o, cos_i, facets.root(wi));
    const Loss lost = lost_from(wo.z, above);
    BsdfLobes both;
    both.pdf = lanes(0.0f);
    const Spectrum once = by_lane([&](int k) {
      const float n_o = above ? 1.0f : ior[k];
      const float n_i = above ? ior[k] : 1.0f;
      const Vec3 half = {n_o * wo.x + n_i * wi.x, n_o * wo.y + n_i * wi.y, n_o * wo.z + n_i * wi.z};
      const float squared = length_squared(half);
      const float scale = (half.z > 0.0f ? 1.0f : -1.0f) / sqrt(squared);
      const float cos_mo = dot(wo, half) * scale;
      const float cos_mi = -dot(wi, half) * scale;
      if (!(cos_mo > 0.0f && cos_mi > 0.0f)) return 0.0f;
      const float common = facets.density(half) * cos_mo * cos_mi / squared;
      const float through = transmittance(k, above, cos_mo, cos_mi);
      const float chance = even() ? through : 1.0f - decision(reflectance(min(cos_mo, 1.0f), above));
      both.pdf[k] = 2.0f * common * n_i * n_i * chance / (wo.z + root_o);
      return common * n_o * n_o * through * masking * cos_i;
    });
    if (!disperses) both.pdf = lanes(both.pdf[0]);
    both.value = once;
    if (lost.chance == 0.0f) return both;
    both.value += by_lane([&](int k) {
      const bool dense = is_dense(k, above);
      const float given_back = lost.share[k] * loss(k).at(!dense, cos_i) / loss(k).mean(!dense);
      const float e = across(k, above);
      return lost.crossing[k] * given_back * inv_pi * cos_i / (e * e);
    });
    both.pdf = both.pdf + lost.chance * (lost.crossing_chance * uniform_hemisphere_pdf - both.pdf);
    return both;
  }

  // 1 - F by the cosines on both sides, without the difference.
  float transmittance(int k, bool above, float cos_o, float cos_i) const {
    if (film.exists()) [[unlikely]]
      return film_transmittance(film, k, ior[k], above ? cos_o : cos_i, above ? cos_i : cos_o);
    const float n_o = above ? 1.0f : ior[k];
    const float n_i = above ? ior[k] : 1.0f;
    const float s = n_o * cos_o + n_i * cos_i;
    const float p = n_i * cos_o + n_o * cos_i;
    return 2.0f * (n_o * n_i) * (cos_o * cos_i) * (1.0f / (s * s) + 1.0f / (p * p));
  }
};

}  // namespace accuray
