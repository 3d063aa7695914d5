// All BSDFs. A new one is a header beside these and a word here.
#pragma once

#include "kernels/bsdf/bases.h"
#include "kernels/bsdf/coated.h"
#include "kernels/bsdf/conductor.h"
#include "kernels/bsdf/dielectric.h"
#include "kernels/bsdf/diffuse.h"
#include "kernels/bsdf/sheen.h"
#include "kernels/bsdf/thin_dielectric.h"
#include "kernels/dispatch.h"

namespace accuray {

using Bsdfs = TypeList<Diffuse, Conductor, Dielectric, ThinDielectric, Sheen, Coated>;
static_assert(starts_with(Bsdfs{}, Bases{}), "a base has the same tag in both lists");
static_assert(tag_of<Coated>(Bsdfs{}) == Coated::tag, "a coated base is known by its tag");

// The header that every material has besides its BSDF.
struct MaterialCommon {
  static constexpr auto params() {
    return param_list(Param{.name = "emission",
                            .kind = Kind::spectrum,
                            .doc = "Spectral radiance that the surface emits; of a texture its colour under D65, times "
                                   "its scale.",
                            .low = 0,
                            .unit = "W/(m^2 sr nm)",
                            .role = "emission",
                            .texturable = true,
                            .takes_flux = true,
                            .animatable = true},
                      Param{.name = "emission_sides",
                            .kind = Kind::choice,
                            .doc = "Sides that emit.",
                            .preset = "\"front\"",
                            .choices = "front|both"},
                      Param{.name = "opacity",
                            .kind = Kind::real,
                            .doc = "Share of the light that meets the surface; the rest passes straight on as if there "
                                   "were nothing. Not for surfaces that emit.",
                            .preset = "1",
                            .low = 0,
                            .high = 1,
                            .unit = "1",
                            .texturable = true,
                            .animatable = true},
                      Param{.name = "normal_map",
                            .kind = Kind::reference,
                            .doc = "Texture whose colours 0 to 1 are the components -1 to 1 of the normal in tangent "
                                   "space; its scale multiplies the slopes.",
                            .role = "texture",
                            .texturable = true},
                      Param{.name = "normal_map_convention",
                            .kind = Kind::choice,
                            .doc = "What green means: opengl up in the picture, directx down.",
                            .preset = "\"opengl\"",
                            .choices = "opengl|directx"},
                      Param{.name = "bump_map",
                            .kind = Kind::reference,
                            .doc = "Texture whose red channel, times its scale and bump_height, raises the surface for "
                                   "shading, along the normal that a normal map gives.",
                            .role = "texture",
                            .texturable = true},
                      Param{.name = "bump_height",
                            .kind = Kind::real,
                            .doc = "Height of the bump map's value 1.",
                            .preset = "0.01",
                            .unit = "m",
                            .animatable = true});
  }
};

}  // namespace accuray
