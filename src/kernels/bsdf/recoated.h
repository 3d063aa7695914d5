// A coat on a coated matte surface: lacquer over glossy paint, three interfaces and the matter under them.
//
// Both upper interfaces with the layer between them are a coat on glass (coat_walk.h); here that is the upper interface
// of a layer which ends at the matte surface. Light that never gets to the latter is the coat's own value. All other
// light is joined at the matte surface, where any two directions see each other: a walk that follows it from wo
// evaluates that surface, at every visit, for the way in that was walked from wi. Each path has one last visit, so it
// is found in one way and no weights are needed.
#pragma once

#include "kernels/bsdf/coat_density.h"
#include "kernels/bsdf/coat_walk.h"

namespace accuray {

inline DiffuseAt matte_below(const CoatLayer& stack) { return {stack.matte_reflectance, stack.matte_roughness}; }
inline Spectrum lower_left(const CoatLayer& stack, float cosine) {
  return LayerShare{stack.lower_share, stack.lower_clear}.left(cosine);
}

// A walk from above or from below the upper interfaces: below them again if w leads downwards.
struct WalkBelow {
  Spectrum weight;
  Vec3 w;
  float eta_scale;
};

// Through the upper interfaces or back from them, and down to the matte surface; false if the walk does not get there.
ACCURAY_INLINE bool to_matte(const CoatLayer& stack, BsdfSample s, WalkBelow& at) {
  at = {at.weight * s.weight, s.wi, at.eta_scale * s.eta_scale};
  if (is_black(at.weight) || s.wi.z > 0.0f) return false;
  at.weight *= lower_left(stack, -s.wi.z);
  return true;
}

// From the matte surface up to the upper interfaces again; false if the walk ends.
ACCURAY_INLINE bool from_matte(const CoatLayer& stack, uint32_t event, CoatNumbers& numbers, WalkBelow& at) {
  const float u = numbers.one();
  const BsdfSample up = matte_below(stack).sample(-at.w, 0.0f, {u, numbers.one()});
  if (is_black(up.weight)) return false;
  at.w = -up.wi;
  at.weight *= up.weight * lower_left(stack, up.wi.z);
  return goes_on(at.weight, at.eta_scale, event, numbers);
}

// Light by way of the matte surface. The first turn follows the way in from wi, the others the path from wo.
ACCURAY_NOINLINE inline Spectrum below_eval(const CoatLayer& stack, Vec3 wo, Vec3 wi) {
  if (wo.z < 0.0f) return matte_below(stack).eval(wo, wi);  // the back has no layers
  CoatNumbers numbers{hash(stack.seed, static_cast<uint32_t>(CoatStream::below_eval))};
  Spectrum value = lanes(0.0f);
  Spectrum arriving = lanes(0.0f);
  Vec3 in = wi;
  WalkBelow at = {lanes(1.0f), wi, 1.0f};
  for (uint32_t event = 0;; ++event) {
    const Vec3 u = numbers.three();
    if (!to_matte(stack, coat_walk(stack, at.w, u, numbers), at)) return value;
    if (event == 0) {
      in = at.w;
      arriving = at.weight * (at.eta_scale * abs(wi.z / in.z));
      at = {lanes(1.0f), wo, 1.0f};
    } else {
      value += at.weight * arriving * matte_below(stack).eval(-at.w, -in);
      if (!from_matte(stack, event, numbers, at)) return value;
    }
  }
}

// The walk itself, as nature does it. By way of the matte surface it has the lobe of that.
ACCURAY_NOINLINE inline BsdfSample below_sample(const CoatLayer& stack, Vec3 wo, float u_lobe, Vec2 u) {
  if (wo.z < 0.0f) return matte_below(stack).sample(wo, u_lobe, u);
  CoatNumbers numbers{hash(stack.seed, static_cast<uint32_t>(CoatStream::below_sample))};
  Vec3 u_event = {u.x, u.y, u_lobe};
  WalkBelow at = {lanes(1.0f), wo, 1.0f};
  uint32_t specular = lobe_specular;
  for (uint32_t event = 0;; ++event) {
    const BsdfSample s = coat_walk(stack, at.w, u_event, numbers);
    specular &= s.lobe;
    if (!to_matte(stack, s, at)) break;
    specular = 0;
    if (!from_matte(stack, event, numbers, at)) return no_sample();
    u_event = numbers.three();
  }
  return {at.w, at.weight, 0.0f, specular, 1.0f};
}

// A guess, like that of a coat: its own, which is given, and the cosine for what passes both interfaces.
ACCURAY_NOINLINE inline float below_pdf(const CoatLayer& stack, Vec3 wo, Vec3 wi, float by_upper) {
  if (wo.z < 0.0f) return matte_below(stack).pdf(wo, wi);
  return fma(CoatDensity(stack).passed(wo.z), cosine_hemisphere_pdf(wi.z), by_upper);
}

}  // namespace accuray
