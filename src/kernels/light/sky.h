// The clear sky of Hosek and Wilkie (2012), "An Analytic Model for Full Spectral Sky-Dome Radiance".
#pragma once

#include "kernels/light/directions.h"
#include "kernels/light/sun.h"

namespace accuray {

// A direction as the model sees it.
struct SkyDirection {
  float cos_zenith, root, per_height;  // of the zenith angle: cosine, its root, 1 / (cosine + 0.01)
  float sun_angle, cos_sun;            // from the sun

  static SkyDirection of(Vec3 wi, Vec3 sun) {
    const float zenith = max(wi.y, 0.0f);
    const float cosine = clamp(dot(wi, sun), -1.0f, 1.0f);
    return {zenith, sqrt(zenith), 1.0f / (zenith + 0.01f), atan2(length(cross(wi, sun)), cosine), cosine};
  }
};

constexpr uint32_t sky_terms = 10;  // of a band: A to I of the paper's eq. 8 as the data order them, and the radiance

// Radiance of one band, eq. 8 with chi of eq. 9.
inline float sky_radiance(const float* t, const SkyDirection& d) {
  const float towards = 1.0f + t[0] * exp(t[1] * d.per_height);
  const float base = fma(t[8], t[8], 1.0f) - 2.0f * t[8] * d.cos_sun;
  const float square = d.cos_sun * d.cos_sun;
  const float mie = (1.0f + square) / (base * sqrt(base));
  const float around = t[2] + t[3] * exp(t[4] * d.sun_angle) + t[5] * square + t[6] * mie + t[7] * d.root;
  return max(towards * around * t[9], 0.0f);
}

struct SkyLight {
  Vec3 sun;        // unit, to its middle
  uint32_t bands;  // entry in the scene's tables of sky_terms numbers for each band
  DirectionTable table;

  static constexpr bool delta = false;
  static constexpr bool infinite = true;
  static constexpr bool partial = true;
  static constexpr const char* name = "sky";
  static constexpr const char* doc =
      "A clear sky by day in absolute units, with its sun (Hosek and Wilkie 2012, 2013). Below the horizon is nothing.";
  static constexpr auto params() {
    return joined(sun_position_params(),
                  param_list(Param{.name = "turbidity",
                                   .kind = Kind::real,
                                   .doc = "Haze: 1 is pure air, 2 to 3 a clear day, 10 a hazy one.",
                                   .preset = "3",
                                   .low = 1,
                                   .high = 10,
                                   .animatable = true},
                             Param{.name = "ground_albedo",
                                   .kind = Kind::spectrum,
                                   .doc = "Reflectance of the land all around, which lights the sky from below.",
                                   .preset = "0.2",
                                   .low = 0,
                                   .high = 1,
                                   .role = "reflectance",
                                   .animatable = true},
                             Param{.name = "sun",
                                   .kind = Kind::boolean,
                                   .doc = "Whether the sun's disc is there too, with its edge darker than its middle.",
                                   .preset = "true"},
                             sun_diameter_param("Angle that the sun's disc fills; its irradiance is the same for all."),
                             Param{.name = "scale",
                                   .kind = Kind::real,
                                   .doc = "Factor of all radiance.",
                                   .preset = "1",
                                   .low = 0,
                                   .animatable = true},
                             visible_param()));
  }

  Drawn draw(const SceneView& scene, Vec2 u) const {
    const Vec3 wi = table.sample(scene, u);
    return {wi, density(scene, wi)};
  }
  float density(const SceneView& scene, Vec3 wi) const { return table.pdf(scene, wi); }
  LightSample sample(const SceneView& scene, Vec3, Vec2 u) const { return sample_from_afar(drawn_by(*this, scene, u)); }
  float pdf(const SceneView& scene, Vec3, Vec3 wi, const Surface&) const { return density_of(*this, scene, wi); }
  Spectrum radiance(const SceneView& scene, const SpectrumRecord& emission, Vec3 wi, const Wavelengths& wl) const {
    if (wi.y <= 0.0f) return lanes(0.0f);
    const SkyDirection direction = SkyDirection::of(wi, sun);
    return emission.scale * between_bands(wl, [&](uint32_t band) {
             return sky_radiance(scene.tables + bands + size_t{band} * sky_terms, direction);
           });
  }
  // Flux into a sphere around the scene; the emission's record is the mean over all directions.
  float power_per_radiance(float scene_radius) const { return 4.0f * pi * pi * scene_radius * scene_radius; }
};

}  // namespace accuray
