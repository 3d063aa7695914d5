// Infinite lights of a scene: environments, suns and skies.
#include <stdexcept>

#include "kernels/math/functions.h"
#include "lower/builder.h"
#include "lower/double3.h"

namespace accuray {

namespace {

// Towards the sun, from its direction or its angles; a unit vector.
std::array<double, 3> sun_direction(const Values& values) {
  if (values.contains("towards")) {
    return unit(vec_of(values, "towards"), "towards", "has no direction: allowed is any length but zero");
  }
  const SinCosDouble up = sincos(number_of(values, "elevation"));
  const SinCosDouble around = sincos(number_of(values, "azimuth"));
  return {up.cos * around.sin, up.sin, -up.cos * around.cos};
}

SunLight sun_disc(const std::array<double, 3>& direction, const Values& values, uint32_t limb) {
  const double sine = sincos(0.25 * number_of(values, "angular_diameter")).sin;
  return {to_vec3(direction), static_cast<float>(2.0 * sine * sine), limb};
}

// Columns of the map's axes in the world: first its turn about +Y, then the transform without its scale.
Frame map_axes(const Values& values, const std::optional<Matrix>& transform) {
  const SinCosDouble turn = sincos(number_of(values, "rotation"));
  const Matrix matrix = transform.value_or(identity_matrix);
  const auto moved = [&](double x, double y, double z) {
    return normalize(to_vec3(transform_vector(matrix, {x, y, z})));
  };
  return {moved(turn.cos, 0.0, -turn.sin), moved(0.0, 1.0, 0.0), moved(turn.sin, 0.0, turn.cos)};
}

// What the values of the bands are worth to a sensor of the response `cmf`: each is a hat of which the sensor sees a
// part.
std::vector<double> band_weights(const std::vector<double>& cmf) {
  std::vector<double> weights(sky_bands, 0.0);
  for (uint32_t i = 0; i < lambda_nodes; ++i) {
    const Wavelengths wl = Wavelengths::at(lanes(lambda_min + static_cast<float>(i)), lanes(1.0f));
    for (uint32_t band = 0; band < sky_bands; ++band) {
      const Spectrum hat = between_bands(wl, [&](uint32_t b) { return b == band ? 1.0f : 0.0f; });
      weights[band] += cmf[3 * i + 1] * static_cast<double>(hat[0]);
    }
  }
  return weights;
}

// Values at 360, 361, ... 830 nm of a spectrum given by its bands.
std::vector<float> band_spectrum(const std::vector<double>& bands) {
  std::vector<float> result(lambda_nodes);
  for (uint32_t i = 0; i < lambda_nodes; ++i) {
    const Wavelengths wl = Wavelengths::at(lanes(lambda_min + static_cast<float>(i)), lanes(1.0f));
    result[i] = between_bands(wl, [&](uint32_t band) { return static_cast<float>(bands[band]); })[0];
  }
  return result;
}

}  // namespace

template <class L>
void SceneBuilder::add_infinite(const L& light, SpectrumRef emission, const Values& values) {
  constexpr bool directional = requires(const SceneView& scene, const SpectrumRecord& record, const Wavelengths& wl) {
    light.radiance(scene, record, Vec3{}, wl);
  };
  infinite_.push_back({lights_.add(light, emission, false), number_of(values, "visible") == 0.0 ? 1u : 0u,
                       directional ? 1u : 0u, L::partial ? 1u : 0u});
}

void SceneBuilder::add_constant(const Values& values, SpectrumRef emission) {
  add_infinite(ConstantLight{}, emission, values);
}

void SceneBuilder::add_sun(const Values& values, SpectrumRef emission, bool is_irradiance) {
  const SunLight sun = sun_disc(sun_direction(values), values, none);
  if (is_irradiance) emission = spectra_.scaled(emission, 1.0 / static_cast<double>(pi * sun.sine_squared()));
  add_infinite(sun, emission, values);
}

void SceneBuilder::add_environment(const Values& values, const std::optional<Matrix>& transform,
                                   const PictureUse& use) {
  const EnvironmentMap& map = environments_.map_of(use);
  const SpectrumRef emission = spectra_.textured_emission(map.texture, number_of(values, "scale"));
  add_infinite(EnvironmentLight{map_axes(values, transform), map.table, static_cast<float>(map.mean)}, emission,
               values);
}

void SceneBuilder::add_sky(const Values& values, SpectrumRef albedo, const SkyData& data) {
  const std::array<double, 3> direction = sun_direction(values);
  if (direction[1] < 0.0) {
    throw BadParameter(values.contains("towards") ? "towards" : "elevation",
                       "has the sun below the horizon, where the model ends: allowed is 0 to 90 degrees above it");
  }
  const Vec3 sun = to_vec3(direction);
  const float elevation = atan2(sun.y, sqrt(fma(sun.x, sun.x, sun.z * sun.z)));
  SkyConditions conditions{static_cast<double>(elevation), number_of(values, "turbidity"), {}};
  for (uint32_t band = 0; band < sky_bands; ++band) {
    conditions.albedo.push_back(spectra_.value(albedo, static_cast<double>(first_band + band_step * band)));
  }
  const double scale = number_of(values, "scale");

  const std::vector<float> bands = sky_table(data, conditions);
  const SkyBrightness sky = sky_brightness(bands, sun, band_weights(spectra_.colour().cmf));
  const uint32_t first = spectra_.add_table(bands);
  const DirectionTable table = make_direction_table(sky.cells, bulk_);
  add_infinite(SkyLight{sun, first, table}, spectra_.directional(band_spectrum(sky.means), scale), values);

  if (number_of(values, "sun") == 0.0) return;
  // The published radiance belongs to the true sun; a larger disc of the same irradiance is less bright.
  constexpr double true_radius = 0.5 * 0.533 * 3.14159265358979323846 / 180.0;
  const double true_sine = sincos(true_radius).sin;
  const SunLight disc = sun_disc(direction, values, 0);
  const std::vector<float> limb =
      sun_table(data, conditions, true_sine * true_sine / static_cast<double>(disc.sine_squared()));
  const SpectrumRef glow = spectra_.directional(band_spectrum(sun_means(limb)), scale);
  add_infinite(SunLight{disc.direction, disc.height, spectra_.add_table(limb)}, glow, values);
}

}  // namespace accuray
