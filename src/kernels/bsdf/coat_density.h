// A cheap density for the directions that leave a coat: a guess of where its light goes, in closed form.
//
// The walk's own density is an integral without a closed form. What needs one is multiple importance sampling alone,
// which is right with any function that both of its techniques agree on; a good guess keeps the noise low. It is
// positive wherever the walk may lead to without being specular.
//
// The guess: the upper interface's own reflection; of what goes through it, light from the base, partly spread by the
// cosine, partly by GGX facets around the direction mirrored inside the layer. These facets are those of the base,
// widened by what refraction at the upper interface's facets adds (variances of slopes add up; Belcour 2018).
#pragma once

#include "kernels/bsdf/coat_walk.h"

namespace accuray {

// What the guess knows of a base.
struct CoatBaseSketch {
  float spread;            // part of its light that goes everywhere
  float alpha_x, alpha_y;  // of its facets
  float behind;            // index behind it relative to the layer
};

constexpr float coat_glossy_spread = 0.2f;
constexpr float coat_least_share = 0.02f;

inline CoatBaseSketch sketch_of(const DiffuseAt&) { return {1.0f, 0.0f, 0.0f, 1.0f}; }
inline CoatBaseSketch sketch_of(const SheenAt&) { return {1.0f, 0.0f, 0.0f, 1.0f}; }
inline CoatBaseSketch sketch_of(const ConductorAt& base) {
  return {coat_glossy_spread, base.facets.alpha_x, base.facets.alpha_y, 1.0f};
}
inline CoatBaseSketch sketch_of(const DielectricAt& base) {
  return {coat_glossy_spread, base.rough.facets.alpha_x, base.rough.facets.alpha_y, 0.25f * sum(base.rough.ior)};
}
inline CoatBaseSketch sketch_of(const ThinDielectricAt& base) {
  return {coat_glossy_spread, 0.0f, 0.0f, 1.0f / base.before[0]};
}

struct CoatDensity {
  const CoatLayer& layer;
  CoatBaseSketch base;
  float index;  // of the layer relative to what is before it

  explicit CoatDensity(const CoatLayer& of)
      : layer(of),
        base(of.base.visit([](const auto& at) { return sketch_of(at); })),
        index(0.25f * sum(of.top.rough.ior)) {}

  float at(Vec3 wo, Vec3 wi) const {
    const bool above = wo.z > 0.0f;
    const bool same = above == (wi.z > 0.0f);
    float result = 0.0f;
    float rest = 1.0f;
    if (above) {
      rest = 1.0f - reflected(wo.z, index);
      if (same && !layer.top.is_delta()) result = coat_lobes(layer, true, wo, wi).pdf[0];
    }
    if (layer.base.transmits()) {
      const float back = reflected(abs(wo.z), above ? base.behind : 1.0f / base.behind);
      rest *= same ? back : 1.0f - back;
    } else if (!above || !same) {
      return 0.0f;
    }
    const float glossy = base.spread < 1.0f ? facets_density(wo, wi, same) : 0.0f;
    return fma(rest, fma(base.spread, cosine_hemisphere_pdf(abs(wi.z)) - glossy, glossy), result);
  }
  // Share of the light from above that gets through to what is behind the base.
  float passed(float cosine) const {
    return (1.0f - reflected(cosine, index)) * (1.0f - reflected(cosine, base.behind));
  }

 private:
  // What a smooth interface would reflect, kept off 0 and 1.
  static float reflected(float cosine, float eta) {
    return clamp(fresnel_dielectric(min(cosine, 1.0f), lanes(eta))[0], coat_least_share, 1.0f - coat_least_share);
  }
  // The direction inside the layer that a smooth interface refracts to w, folded upwards; z = 0 if there is none.
  Vec3 inside(Vec3 w, float eta) const {
    const float x = w.x / eta;
    const float y = w.y / eta;
    return {x, y, sqrt(max(0.0f, 1.0f - fma(x, x, y * y)))};
  }
  // The square of the width of slopes at which plain reflection spreads light as much as the layer does.
  float width2(float upper, float lower, bool above, bool same) const {
    const float by_top = upper * (1.0f - 1.0f / index) * 0.5f;
    if (above) return same ? fma(lower, lower, 2.0f * by_top * by_top) : crossing_width2(by_top, lower);
    return same ? fma(lower, lower, upper * upper) : crossing_width2(by_top, lower);
  }
  float crossing_width2(float by_top, float lower) const {
    const float by_base = 0.5f * lower * (base.behind - 1.0f);
    return fma(by_top, by_top, by_base * by_base);
  }
  float facets_density(Vec3 wo, Vec3 wi, bool same) const {
    const bool above = wo.z > 0.0f;
    const Ggx& top = layer.top.rough.facets;
    const Ggx facets = {sqrt(width2(top.alpha_x, base.alpha_x, above, same)) + smallest_alpha,
                        sqrt(width2(top.alpha_y, base.alpha_y, above, same)) + smallest_alpha};
    Vec3 o = {wo.x, wo.y, abs(wo.z)};
    Vec3 i = {wi.x, wi.y, abs(wi.z)};
    float scale = 1.0f;  // solid angle in the layer over that outside
    if (above || !same) {
      const float e_i = wi.z > 0.0f ? index : 1.0f / base.behind;
      o = inside(wo, above ? index : 1.0f / base.behind);
      i = inside(wi, e_i);
      if (o.z == 0.0f || i.z == 0.0f) return 0.0f;
      scale = abs(wi.z) / (i.z * e_i * e_i);
    }
    const Vec3 half = {o.x + i.x, o.y + i.y, max(o.z + i.z, 0x1p-50f)};
    return 0.5f * facets.density(half) / (o.z + facets.root(o)) * scale;
  }
};

ACCURAY_NOINLINE inline float coat_pdf(const CoatLayer& layer, Vec3 wo, Vec3 wi) {
  return CoatDensity(layer).at(wo, wi);
}

}  // namespace accuray
