// An environment given by an equirectangular picture.
#pragma once

#include "kernels/light/directions.h"
#include "kernels/light/light.h"
#include "kernels/texture/list.h"

namespace accuray {

struct EnvironmentLight {
  Frame axes;  // of the map, in the world; mirrored ones too
  DirectionTable table;
  float mean;  // luminance over all directions, relative to the emission's white

  static constexpr bool delta = false;
  static constexpr bool infinite = true;
  static constexpr bool partial = false;
  static constexpr const char* name = "environment";
  static constexpr const char* doc =
      "An infinitely distant environment given by an equirectangular picture. Its middle lies at -Z, its right half "
      "towards +X, its top at +Y: what a panorama camera sees.";
  static constexpr auto params() {
    return param_list(
        Param{.name = "file",
              .kind = Kind::file,
              .doc = "Image file: OpenEXR, HDR and whatever else OpenImageIO reads.",
              .role = "image",
              .group = "source:file"},
        Param{.name = "pixels",
              .kind = Kind::array,
              .doc = "The picture itself, height x width or height x width x channels, from the top; integers of 8 or "
                     "16 bits count as 0 to 1.",
              .role = "pixels",
              .group = "source:pixels"},
        Param{.name = "color_space",
              .kind = Kind::choice,
              .doc = "What the stored colours are: srgb (the sRGB curve is undone) or linear (linear Rec.709). auto: "
                     "integers are srgb, floats are linear.",
              .preset = "\"auto\"",
              .choices = "auto|srgb|linear"},
        Param{.name = "scale",
              .kind = Kind::real,
              .doc = "Factor of the radiance; with 1 the colour [1, 1, 1] is D65 with Y = 1.",
              .preset = "1",
              .low = 0,
              .animatable = true},
        Param{.name = "rotation",
              .kind = Kind::real,
              .doc = "Angle by which the map is turned about +Y, counter-clockwise seen from above.",
              .preset = "0",
              .unit = "deg",
              .animatable = true},
        Param{.name = "transform",
              .kind = Kind::transform,
              .doc = "From the turned map to the world; only its rotation and mirroring count."},
        visible_param());
  }

  Drawn draw(const SceneView& scene, Vec2 u) const {
    const Vec3 wi = axes.to_world(table.sample(scene, u));
    return {wi, density(scene, wi)};
  }
  float density(const SceneView& scene, Vec3 wi) const { return table.pdf(scene, axes.to_local(wi)); }
  LightSample sample(const SceneView& scene, Vec3, Vec2 u) const { return sample_from_afar(drawn_by(*this, scene, u)); }
  float pdf(const SceneView& scene, Vec3, Vec3 wi, const Surface&) const { return density_of(*this, scene, wi); }
  Spectrum radiance(const SceneView& scene, const SpectrumRecord& emission, Vec3 wi, const Wavelengths& wl) const {
    const Vec2 place = map_place(axes.to_local(wi));
    TexturePoint point{};
    point.uv = {place.x, 1.0f - place.y};
    return textured_spectrum(scene, emission, point, wl);
  }
  // Flux into a sphere around the scene.
  float power_per_radiance(float scene_radius) const { return 4.0f * pi * pi * scene_radius * scene_radius * mean; }
};

}  // namespace accuray
