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

struct CoatLayer {
  DielectricAt top;  // from what is before the surface into the layer
  BaseAt base;       // what is before it is the layer
  Spectrum share;    // of the light that is left after crossing the layer straight
  bool clear;
  bool hero_only;
  uint32_t seed;

  bool is_delta(bool at_top) const { return at_top ? top.is_delta() : base.is_delta(); }
  Spectrum eval(bool at_top, Vec3 wo, Vec3 wi) const { return at_top ? top.eval(wo, wi) : base.eval(wo, wi); }
  Spectrum pdfs(bool at_top, Vec3 wo, Vec3 wi) const { return at_top ? top.pdfs(wo, wi) : base.pdfs(wo, wi); }
  BsdfSample sample(bool at_top, Vec3 wo, Vec3 u) const {
    return at_top ? top.sample(wo, u.z, {u.x, u.y}) : base.sample(wo, u.z, {u.x, u.y});
  }
  // Share that one crossing leaves, in a direction of this cosine.
  Spectrum left(float cosine) const {
    if (clear) return lanes(1.0f);
    Spectrum result = share;
    for (int k = 0; k < 4; ++k) {
      result[k] = static_cast<float>(pow(static_cast<double>(share[k]), 1.0 / static_cast<double>(cosine)));
    }
    return result;
  }
  // What leads through the interface from outside. A smooth upper interface leaves no choice but to refract.
  BsdfSample through(bool at_top, Vec3 w, Vec3 u) const {
    BsdfSample s;
    if (at_top && top.is_delta()) {
      const Spectrum eta = top.rough.ior;
      const float chance = chance_for_all(fresnel_dielectric(abs(w.z), eta), hero_only);
      s = top.sample(w, one_minus_epsilon, {u.x, u.y});
      s.weight *= 1.0f - chance;
    } else {
      s = sample(at_top, w, u);
    }
    return (s.lobe & lobe_transmission) != 0 ? s : no_sample();
  }
};

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

enum class CoatStream : uint32_t { sample = 0x636f6174u, eval = 0x65766f63u };

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

// The walk itself. The first numbers are given; a mirror leaves two of them to the event that follows.
ACCURAY_NOINLINE inline BsdfSample coat_sample(const CoatLayer& layer, Vec3 wo, float u_lobe, Vec2 u) {
  CoatNumbers numbers{hash(layer.seed, static_cast<uint32_t>(CoatStream::sample))};
  Vec3 u_event = {u.x, u.y, u_lobe};
  BsdfSample result = {wo, lanes(1.0f), 0.0f, lobe_specular, 1.0f};
  Vec3 w = wo;
  bool at_top = wo.z > 0.0f;
  for (uint32_t event = 0;; ++event) {
    const BsdfSample s = layer.sample(at_top, w, u_event);
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

// Light from wi that reaches wo in any way but by mirrors alone. Where the walk is at the interface that leads out to
// wi it scatters there; where it is at the other, light comes straight from the way in that was chosen for wi. Both
// find the same paths where both interfaces are rough, and are weighted by the power heuristic then.
ACCURAY_NOINLINE inline Spectrum coat_eval(const CoatLayer& layer, Vec3 wo, Vec3 wi) {
  CoatNumbers numbers{hash(layer.seed, static_cast<uint32_t>(CoatStream::eval))};
  const bool exit_top = wi.z > 0.0f;
  const BsdfSample in = layer.through(exit_top, wi, numbers.three());
  const bool in_is_delta = layer.is_delta(exit_top);
  const bool found_in = !is_black(in.weight) && in.wi.z != 0.0f;
  const Spectrum arriving =
      found_in ? in.weight * layer.left(abs(in.wi.z)) * (in.eta_scale * abs(wi.z / in.wi.z)) : lanes(0.0f);
  Spectrum value = lanes(0.0f);
  Spectrum weight = lanes(1.0f);
  float eta_scale = 1.0f;
  float pdf = 0.0f;  // with which the walk chose w; 0 if it had no choice
  bool hero = layer.hero_only;
  Vec3 w = wo;
  bool at_top = wo.z > 0.0f;
  for (uint32_t event = 0;; ++event) {
    if (at_top == exit_top) {
      if (!in_is_delta) {
        Spectrum scattered = weight * layer.eval(at_top, w, wi);
        if (pdf > 0.0f) {
          const Spectrum other = layer.pdfs(at_top, wi, w);
          scattered *= pdf * pdf / (pdf * pdf + other * other);
        }
        value += scattered;
      }
    } else if (found_in && !layer.is_delta(at_top)) {
      Spectrum scattered = weight * layer.eval(at_top, w, -in.wi) * arriving;
      if (!in_is_delta) {
        const Spectrum other = layer.pdfs(at_top, w, -in.wi);
        scattered *= in.pdf * in.pdf / (in.pdf * in.pdf + other * other);
      }
      value += !hero && (in.lobe & lobe_disperses) != 0 ? keep_hero(scattered) : scattered;
    }
    const BsdfSample s = layer.sample(at_top, w, numbers.three());
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
