// A disc infinitely far away, of the size that the sun has in the sky.
#pragma once

#include "kernels/light/bands.h"
#include "kernels/light/light.h"

namespace accuray {

// Where the sun stands, for the lights that have one.
constexpr auto sun_position_params() {
  return param_list(
      Param{.name = "towards",
            .kind = Kind::vec,
            .doc = "Direction to the sun, of any length.",
            .group = "position:vector",
            .animatable = true},
      Param{.name = "elevation",
            .kind = Kind::real,
            .doc = "Angle of the sun above the horizon.",
            .preset = "45",
            .low = -90,
            .high = 90,
            .unit = "deg",
            .group = "position:angles",
            .animatable = true},
      Param{.name = "azimuth",
            .kind = Kind::real,
            .doc = "Where it stands along the horizon: 0 at -Z, 90 at +X, as on a compass with north at -Z.",
            .preset = "0",
            .unit = "deg",
            .group = "position:angles",
            .animatable = true});
}
constexpr Param sun_diameter_param(const char* doc) {
  return {.name = "angular_diameter",
          .kind = Kind::real,
          .doc = doc,
          .preset = "0.533",
          .low = 0.001,
          .high = 180,
          .unit = "deg",
          .animatable = true};
}

struct SunLight {
  Vec3 direction;  // unit, to its middle
  float height;    // 1 - cos of its angular radius
  uint32_t limb;   // darkening: entry in the scene's tables of band_terms numbers for each band; none: uniform

  static constexpr uint32_t band_terms = 6;

  static constexpr bool delta = false;
  static constexpr bool infinite = true;
  static constexpr bool partial = true;
  static constexpr const char* name = "sun";
  static constexpr const char* doc = "A disc infinitely far away, of equal radiance all over.";
  static constexpr auto params() {
    return joined(sun_position_params(),
                  param_list(sun_diameter_param(
                                 "Angle that the disc fills. Under a given irradiance a larger one is less bright."),
                             Param{.name = "irradiance",
                                   .kind = Kind::spectrum,
                                   .doc = "Spectral irradiance on a surface that faces the sun.",
                                   .preset = "1",
                                   .low = 0,
                                   .unit = "W/(m^2 nm)",
                                   .role = "emission",
                                   .group = "amount:irradiance",
                                   .animatable = true},
                             Param{.name = "radiance",
                                   .kind = Kind::spectrum,
                                   .doc = "Spectral radiance of the disc.",
                                   .low = 0,
                                   .unit = "W/(m^2 sr nm)",
                                   .role = "emission",
                                   .group = "amount:radiance",
                                   .animatable = true},
                             visible_param()));
  }

  // (2 sin(angle / 2))^2 of the angle from the middle, which the difference of unit vectors keeps exact.
  float chord_squared(Vec3 wi) const { return length_squared(wi - direction); }
  bool covers(Vec3 wi) const { return chord_squared(wi) <= 2.0f * height; }
  float solid_angle() const { return 2.0f * pi * height; }
  // sin^2 of its angular radius; irradiance is pi times that for each unit of radiance, up to a hemisphere.
  float sine_squared() const { return height * (2.0f - height); }

  Drawn draw(const SceneView&, Vec2 u) const {
    const float drop = u.x * height;
    const float around = sqrt(max(0.0f, drop * (2.0f - drop)));
    const SinCos phi = sincos(2.0f * pi * u.y);
    const Vec3 wi = Frame::around(direction).to_world({around * phi.cos, around * phi.sin, 1.0f - drop});
    return {wi, 1.0f / solid_angle()};
  }
  float density(const SceneView&, Vec3 wi) const { return covers(wi) ? 1.0f / solid_angle() : 0.0f; }
  LightSample sample(const SceneView& scene, Vec3, Vec2 u) const { return sample_from_afar(drawn_by(*this, scene, u)); }
  float pdf(const SceneView& scene, Vec3, Vec3 wi, const Surface&) const { return density_of(*this, scene, wi); }

  // Limb darkening is a polynomial in the cosine at which the sun's own surface is seen (Hosek and Wilkie 2013).
  Spectrum radiance(const SceneView& scene, const SpectrumRecord& emission, Vec3 wi, const Wavelengths& wl) const {
    if (!covers(wi)) return lanes(0.0f);
    if (limb == none) return evaluate(emission, scene.tables, wl);
    const float chord = chord_squared(wi);
    const float cosine = sqrt(max(0.0f, 1.0f - chord * (1.0f - 0.25f * chord) / sine_squared()));
    return emission.scale * between_bands(wl, [&](uint32_t band) {
             const float* terms = scene.tables + limb + size_t{band} * band_terms;
             float sum = terms[band_terms - 1];
             for (uint32_t i = band_terms - 1; i-- > 0;) sum = fma(sum, cosine, terms[i]);
             return max(sum, 0.0f);
           });
  }
  // Flux into a sphere around the scene.
  float power_per_radiance(float scene_radius) const { return pi * pi * scene_radius * scene_radius * sine_squared(); }
};

}  // namespace accuray
