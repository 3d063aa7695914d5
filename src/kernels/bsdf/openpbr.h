// OpenPBR Surface (Academy Software Foundation 2024, version 1.1): the parameters of an artist's material that is put
// together from the materials of this renderer before it is lowered (accuray/scene/openpbr.py). It never runs itself.
#pragma once

#include "kernels/dispatch.h"
#include "kernels/schema.h"

namespace accuray {

namespace openpbr {

constexpr Param share(const char* name, const char* doc, const char* preset) {
  return {.name = name, .doc = doc, .preset = preset, .low = 0, .high = 1, .unit = "1", .texturable = true};
}
constexpr Param plain_share(const char* name, const char* doc, const char* preset) {
  return {.name = name, .doc = doc, .preset = preset, .low = 0, .high = 1, .unit = "1"};
}
constexpr Param colour(const char* name, const char* doc, const char* preset) {
  return {.name = name,
          .kind = Kind::spectrum,
          .doc = doc,
          .preset = preset,
          .low = 0,
          .high = 1,
          .unit = "1",
          .role = "reflectance",
          .texturable = true};
}
constexpr Param plain_colour(const char* name, const char* doc, const char* preset) {
  Param param = colour(name, doc, preset);
  param.texturable = false;
  return param;
}
constexpr Param index(const char* name, const char* doc, const char* preset) {
  return {.name = name, .doc = doc, .preset = preset, .low = 1, .high = 3, .unit = "1"};
}

}  // namespace openpbr

struct OpenPbr {
  static constexpr const char* name = "openpbr";
  static constexpr const char* doc =
      "OpenPBR Surface 1.1: metal, plastic, glass, varnish and cloth in one material of many weights. Its subsurface "
      "and scattering parameters are not there yet.";

 private:
  static constexpr auto base() {
    using namespace openpbr;
    return param_list(share("base_weight", "Factor of base_color.", "1"),
                      colour("base_color", "Reflectance of the matte base, and of the metal along the normal.", "0.8"),
                      share("base_metalness", "Share of metal.", "0"),
                      share("base_diffuse_roughness", "Roughness of the matte base, as of `diffuse`.", "0"));
  }
  static constexpr auto specular() {
    using namespace openpbr;
    return param_list(
        share("specular_weight", "Factor of the reflection along the normal: changes the index of a dielectric.", "1"),
        plain_colour("specular_color", "Tint of metal towards its edge; of a dielectric it must be white.", "1"),
        share("specular_roughness", "Roughness of the reflection.", "0.3"),
        share("specular_roughness_anisotropy", "Stretches highlights along the surface's u.", "0"),
        index("specular_ior", "Index of refraction of the dielectric.", "1.5"));
  }
  static constexpr auto transmission() {
    using namespace openpbr;
    return param_list(
        share("transmission_weight", "Share of the dielectric that is clear, not matte.", "0"),
        plain_colour("transmission_color",
                     "What is left of the light after transmission_depth, or after each crossing of the surface.", "1"),
        Param{.name = "transmission_depth",
              .doc = "Way inside the body after which transmission_color is left; 0: clear.",
              .preset = "0",
              .low = 0,
              .unit = "m"},
        plain_share("transmission_dispersion_scale", "Factor of the dispersion; 0: none.", "0"),
        Param{.name = "transmission_dispersion_abbe_number",
              .doc = "Abbe number of the dielectric at full dispersion.",
              .preset = "20",
              .low = 9,
              .high = 91});
  }
  static constexpr auto coat() {
    using namespace openpbr;
    return param_list(
        share("coat_weight", "Share of the surface under a coat.", "0"),
        plain_colour("coat_color", "Share of the light left on the straight way in and out.", "1"),
        share("coat_roughness", "Roughness of the coat.", "0"),
        share("coat_roughness_anisotropy", "Stretches the coat's highlights.", "0"),
        index("coat_ior", "Index of refraction of the coat.", "1.6"),
        plain_share("coat_darkening",
                    "Share of the darkening that light sent back inside the coat gives a matte base; 1 is nature's.",
                    "1"),
        share("fuzz_weight", "Share of the surface under fibres.", "0"),
        colour("fuzz_color", "Reflectance of the fibres.", "1"),
        share("fuzz_roughness", "Roughness of the fibres.", "0.5"));
  }
  static constexpr auto film() {
    using namespace openpbr;
    return param_list(share("thin_film_weight", "Share of the surface under a film.", "0"),
                      Param{.name = "thin_film_thickness",
                            .doc = "Thickness of the film.",
                            .preset = "500",
                            .low = 0,
                            .high = 1e5,
                            .unit = "nm",
                            .texturable = true},
                      index("thin_film_ior", "Index of refraction of the film.", "1.4"));
  }
  static constexpr auto geometry() {
    using namespace openpbr;
    return param_list(Param{.name = "emission_luminance",
                            .doc = "Luminance of emission_color where that is white; in place of `emission`.",
                            .preset = "0",
                            .low = 0,
                            .unit = "cd/m^2"},
                      Param{.name = "emission_color",
                            .kind = Kind::spectrum,
                            .doc = "Colour of the emission.",
                            .preset = "[1, 1, 1]",
                            .low = 0,
                            .unit = "1",
                            .role = "emission",
                            .texturable = true},
                      Param{.name = "geometry_thin_walled",
                            .kind = Kind::boolean,
                            .doc = "The surface is a thin wall, not the bound of a body: what is clear refracts "
                                   "nothing; its front is as rough as it says, its back smooth.",
                            .preset = "false"});
  }

 public:
  static constexpr auto params() {
    using namespace openpbr;
    return joined(joined(base(), specular()), joined(joined(transmission(), coat()), joined(film(), geometry())));
  }
};

using MaterialModels = TypeList<OpenPbr>;

}  // namespace accuray
