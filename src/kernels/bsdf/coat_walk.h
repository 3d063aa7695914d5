// Light between a thin layer's upper interface and the base under it: random walks from one to the other, in which only
// directions matter (Guo, Hasan and Zhao 2018).
//
// Conventions
//   - Both interfaces lie in one plane, in one frame; what goes up inside the layer meets the upper one from below.
//   - A walk follows light backwards from wo. It is at the upper interface or at the base, and `w` leads from there to
//     where the walk came from.
//   - Refraction into the layer scales radiance, refraction out of it scales it back, so weights are simply multiplied.
//   - Numbers come from a hashed stream of the hit's own. After a refraction that depends on the wavelength the hero
//     goes on alone.
#pragma once

#include "kernels/bsdf/bases.h"
#include "kernels/math/functions.h"
#include "kernels/sampling/hash.h"

namespace accuray {

// What crossing a layer straight leaves of the light.
struct LayerShare {
  Spectrum share;
  bool clear;

  static bool is_clear(Spectrum share) { return min(min(share[0], share[1]), min(share[2], share[3])) >= 1.0f; }
  // In a direction of this cosine.
  Spectrum left(float cosine) const {
    if (clear) return lanes(1.0f);
    Spectrum result = share;
    for (int k = 0; k < 4; ++k) {
      result[k] = static_cast<float>(pow(static_cast<double>(share[k]), 1.0 / static_cast<double>(cosine)));
    }
    return result;
  }
};

struct CoatLayer {
  DielectricAt top;  // from what is before the surface into the layer
  Spectrum share;    // of the light that is left after crossing the layer straight
  // What is before it is the layer. On GPUs the layer lies in a thread's own memory, of which there is little.
  [[no_unique_address]] BaseAt base;
  bool clear;
  bool twice;        // the base is the surface of a second layer, upon a matte surface (recoated.h)
  bool lower_clear;  // as `clear`, of the second layer
  uint8_t lobe;
  uint32_t seed;
  float matte_roughness;
  Spectrum matte_reflectance;
  Spectrum lower_share;

  bool hero_only() const { return top.rough.hero_only; }
  bool is_delta(bool at_top) const { return at_top ? top.is_delta() : base.is_delta(); }

  // Calls fn with the values of the interface. The upper one is a dielectric like one of the bases.
  template <class Fn>
  ACCURAY_INLINE auto visit(bool at_top, Fn&& fn) const {
    return dispatch(Bases{}, at_top ? tag_of<Dielectric>(Bases{}) : base.tag, [&](auto type) {
      using Bsdf = typename decltype(type)::type;
      if constexpr (is_same<Bsdf, Dielectric>) {
        return fn(at_top ? top : base.values.template get<Dielectric>());
      } else {
        return fn(base.values.template get<Bsdf>());
      }
    });
  }
  Spectrum left(float cosine) const { return LayerShare{share, clear}.left(cosine); }
};

// A sample of one of the interfaces.
ACCURAY_NOINLINE inline BsdfSample coat_event(const CoatLayer& layer, bool at_top, Vec3 wo, Vec3 u) {
  return layer.visit(at_top, [&](const auto& at) { return at.sample(wo, u.z, {u.x, u.y}); });
}

// Value and density of one of the interfaces.
ACCURAY_NOINLINE inline BsdfLobes coat_lobes(const CoatLayer& layer, bool at_top, Vec3 wo, Vec3 wi) {
  return layer.visit(at_top, [&](const auto& at) {
    if constexpr (requires { at.lobes(wo, wi); }) {
      const auto both = at.lobes(wo, wi);
      return BsdfLobes{both.value, lanes(1.0f) * both.pdf};
    } else {
      return BsdfLobes{at.eval(wo, wi), lanes(at.pdf(wo, wi))};
    }
  });
}

// A walk's own stream of numbers.
struct CoatNumbers {
  uint32_t key;
  uint32_t drawn = 0;

  float one() { return uniform(hash(key, drawn++)); }
  Vec3 three() {
    const float x = one();
    const float y = one();
    return {x, y, one()};
  }
};

enum class CoatStream : uint32_t {
  sample = 0x636f6174u,
  eval = 0x65766f63u,
  below_sample = 0x62656c73u,
  below_eval = 0x62656c65u
};

// Ends walks that carry little, and makes sure that all of them end.
constexpr uint32_t coat_roulette_event = 8;
constexpr float coat_most_chance = 0.98f;
inline bool goes_on(Spectrum& weight, float eta_scale, uint32_t event, CoatNumbers& numbers) {
  if (event < coat_roulette_event) return true;
  const float chance = min(max_lane(weight) * eta_scale, coat_most_chance);
  if (!(numbers.one() < chance)) return false;
  weight *= 1.0f / chance;
  return true;
}

// What leads through the interface from outside. A smooth upper interface leaves no choice but to refract.
inline BsdfSample coat_entry(const CoatLayer& layer, bool at_top, Vec3 w, Vec3 u) {
  float share = 1.0f;
  if (at_top && layer.top.is_delta()) {
    share = 1.0f - chance_for_all(layer.top.rough.reflectance(abs(w.z), true), layer.hero_only());
    u.z = one_minus_epsilon;
  }
  BsdfSample s = coat_event(layer, at_top, w, u);
  if ((s.lobe & lobe_transmission) == 0) return no_sample();
  s.weight *= share;
  return s;
}

// The walk itself, until it leaves both interfaces. The numbers of its first event are given; a mirror leaves two of
// them to the one that follows.
ACCURAY_INLINE BsdfSample coat_walk(const CoatLayer& layer, Vec3 wo, Vec3 u, CoatNumbers& numbers) {
  Vec3 u_event = u;
  BsdfSample result = {wo, lanes(1.0f), 0.0f, lobe_specular, 1.0f};
  Vec3 w = wo;
  bool at_top = wo.z > 0.0f;
  for (uint32_t event = 0;; ++event) {
    const BsdfSample s = coat_event(layer, at_top, w, u_event);
    if (is_black(s.weight) || s.wi.z == 0.0f) return no_sample();
    result.weight *= s.weight;
    result.eta_scale *= s.eta_scale;
    result.lobe = (result.lobe & s.lobe & lobe_specular) | ((result.lobe | s.lobe) & lobe_disperses);
    if ((s.lobe & lobe_disperses) != 0) result.weight = lanes(result.weight[0], 0.0f, 0.0f, 0.0f);
    if ((s.wi.z > 0.0f) == at_top) {
      result.wi = s.wi;
      return result;
    }
    result.weight *= layer.left(abs(s.wi.z));
    if (!goes_on(result.weight, result.eta_scale, event, numbers)) return no_sample();
    w = -s.wi;
    at_top = !at_top;
    u_event = event == 0 && (s.lobe & lobe_specular) != 0 ? Vec3{u.x, u.y, numbers.one()} : numbers.three();
  }
}

ACCURAY_NOINLINE inline BsdfSample coat_sample(const CoatLayer& layer, Vec3 wo, float u_lobe, Vec2 u) {
  CoatNumbers numbers{hash(layer.seed, static_cast<uint32_t>(CoatStream::sample))};
  return coat_walk(layer, wo, {u.x, u.y, u_lobe}, numbers);
}

// Share of the first of two techniques by the power heuristic, by lane.
inline Spectrum share_of(float pdf, Spectrum other) { return pdf * pdf / (pdf * pdf + other * other); }

// Light from wi that reaches wo in any way but by mirrors alone. Where the walk is at the interface that leads out to
// wi it scatters there; where it is at the other, light comes straight from the way in that was chosen for wi. Both
// find the same paths where both interfaces are rough, and are weighted by the power heuristic then.
ACCURAY_NOINLINE inline Spectrum coat_eval(const CoatLayer& layer, Vec3 wo, Vec3 wi) {
  CoatNumbers numbers{hash(layer.seed, static_cast<uint32_t>(CoatStream::eval))};
  const bool exit_top = wi.z > 0.0f;
  const BsdfSample in = coat_entry(layer, exit_top, wi, numbers.three());
  const bool in_is_delta = layer.is_delta(exit_top);
  const bool found_in = !is_black(in.weight) && in.wi.z != 0.0f;
  const Spectrum arriving =
      found_in ? in.weight * layer.left(abs(in.wi.z)) * (in.eta_scale * abs(wi.z / in.wi.z)) : lanes(0.0f);
  Spectrum value = lanes(0.0f);
  Spectrum weight = lanes(1.0f);
  float eta_scale = 1.0f;
  float pdf = 0.0f;  // with which the walk chose w; 0 if it had no choice
  bool hero = layer.hero_only();
  Vec3 w = wo;
  bool at_top = wo.z > 0.0f;
  for (uint32_t event = 0;; ++event) {
    // Here the walk may scatter towards the light, along wi or along the way in.
    const bool last = at_top == exit_top;
    if (!layer.is_delta(at_top) && (last || found_in)) {
      const BsdfLobes here = coat_lobes(layer, at_top, w, last ? wi : -in.wi);
      Spectrum scattered = weight * here.value;
      if (last) {
        if (pdf > 0.0f) scattered *= share_of(pdf, coat_lobes(layer, at_top, wi, w).pdf);
      } else {
        scattered *= arriving;
        if (!in_is_delta) scattered *= share_of(in.pdf, here.pdf);
        if (!hero && (in.lobe & lobe_disperses) != 0) scattered = keep_hero(scattered);
      }
      value += scattered;
    }
    const BsdfSample s = coat_event(layer, at_top, w, numbers.three());
    if (is_black(s.weight) || s.wi.z == 0.0f || (s.wi.z > 0.0f) == at_top) return value;
    weight *= s.weight * layer.left(abs(s.wi.z));
    eta_scale *= s.eta_scale;
    if ((s.lobe & lobe_disperses) != 0 && !hero) {
      weight = keep_hero(weight);
      hero = true;
    }
    if (!goes_on(weight, eta_scale, event, numbers)) return value;
    pdf = s.pdf;
    w = -s.wi;
    at_top = !at_top;
  }
}

}  // namespace accuray
