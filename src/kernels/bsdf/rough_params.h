// The parameters that rough surfaces of facets share, and what they are at a hit.
#pragma once

#include "kernels/bsdf/bsdf.h"
#include "kernels/bsdf/energy.h"

namespace accuray {

inline bool is_stretched(const RealRef& anisotropy) { return anisotropy.texture != none || anisotropy.value > 0.0f; }

struct FacetsAt {
  Ggx facets;
  EnergyPlace place;

  static FacetsAt of(const ShadingPoint& p, const RealRef& roughness, const RealRef& anisotropy, uint32_t compensate) {
    const float rough = p.real(roughness);
    const float stretch = p.real(anisotropy);
    return {Ggx::of(rough, stretch), EnergyPlace::of(rough, stretch, compensate != 0)};
  }
};

constexpr Param roughness_param(uint32_t member) {
  return share_param(
      "roughness",
      "0 is smooth, 1 the roughest; the square root of the facets' alpha. Below 0.032 the surface is smooth.", "0",
      member);
}
constexpr Param anisotropy_param(uint32_t member) {
  return share_param("anisotropy",
                     "Stretches highlights along the surface's u: the facets' alpha across it is 1 - anisotropy of "
                     "that along it, but at "
                     "least a twentieth.",
                     "0", member);
}
constexpr Param compensate_param(uint32_t member) {
  return {.name = "compensate",
          .kind = Kind::boolean,
          .doc = "Gives back the light that scatters more than once among the facets, which single scattering loses.",
          .preset = "true",
          .member = member};
}

}  // namespace accuray
