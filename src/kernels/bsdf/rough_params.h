// The parameters that rough surfaces of facets share.
#pragma once

#include "kernels/schema.h"

namespace accuray {

constexpr Param roughness_param(uint32_t member) {
  return {
      .name = "roughness",
      .kind = Kind::real,
      .doc = "0 is smooth, 1 the roughest; the square root of the facets' alpha. Below 0.032 the surface is smooth.",
      .preset = "0",
      .low = 0,
      .high = 1,
      .texturable = true,
      .animatable = true,
      .member = member};
}
constexpr Param anisotropy_param(uint32_t member) {
  return {.name = "anisotropy",
          .kind = Kind::real,
          .doc =
              "Stretches highlights along the surface's u: the facets' alpha across it is 1 - anisotropy of that along "
              "it, but at least a twentieth.",
          .preset = "0",
          .low = 0,
          .high = 1,
          .texturable = true,
          .animatable = true,
          .member = member};
}
constexpr Param compensate_param(uint32_t member) {
  return {.name = "compensate",
          .kind = Kind::boolean,
          .doc = "Gives back the light that scatters more than once among the facets, which single scattering loses.",
          .preset = "true",
          .member = member};
}

}  // namespace accuray
