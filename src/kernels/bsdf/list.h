// All BSDFs. A new one is a header beside these and a word here.
#pragma once

#include "kernels/bsdf/conductor.h"
#include "kernels/bsdf/dielectric.h"
#include "kernels/bsdf/diffuse.h"
#include "kernels/bsdf/thin_dielectric.h"
#include "kernels/dispatch.h"

namespace accuray {

using Bsdfs = TypeList<Diffuse, Conductor, Dielectric, ThinDielectric>;

// The header that every material has besides its BSDF.
struct MaterialCommon {
  static constexpr auto params() {
    return param_list(Param{.name = "emission",
                            .kind = Kind::spectrum,
                            .doc = "Spectral radiance that the surface emits.",
                            .low = 0,
                            .unit = "W/(m^2 sr nm)",
                            .role = "emission",
                            .animatable = true},
                      Param{.name = "emission_sides",
                            .kind = Kind::choice,
                            .doc = "Sides that emit.",
                            .preset = "\"front\"",
                            .choices = "front|both"});
  }
};

}  // namespace accuray
