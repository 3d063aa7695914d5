// The sky and sun of Hosek and Wilkie (2012, 2013) for one place of the sun.
#pragma once

#include <span>
#include <vector>

#include "kernels/light/sky.h"
#include "lower/direction_table.h"

namespace accuray {

constexpr size_t sky_albedos = 2;
constexpr size_t sky_turbidities = 10;
constexpr size_t sky_points = 6;  // of a Bezier curve over the sun's elevation
constexpr size_t sun_pieces = 45;
constexpr size_t sun_powers = 4;

// The published coefficients, in the order of accuray/data/hosek_wilkie_spectral.json.
struct SkyData {
  std::vector<double> sky;       // band, albedo, turbidity, point, 9 terms
  std::vector<double> radiance;  // band, albedo, turbidity, point
  std::vector<double> sun;       // band, turbidity, piece, power from the highest
  std::vector<double> limb;      // band, power from the lowest
};

struct SkyConditions {
  double elevation;            // of the sun, radians, 0 to pi/2
  double turbidity;            // 1 to 10
  std::vector<double> albedo;  // of the ground, for each band
};

// sky_terms numbers for each band. Throws std::invalid_argument for data of another size.
std::vector<float> sky_table(const SkyData& data, const SkyConditions& conditions);

// SunLight::band_terms numbers for each band, times `factor`. Departure: the whole disc is dimmed by the air that lies
// before its middle.
std::vector<float> sun_table(const SkyData& data, const SkyConditions& conditions, double factor);

// Mean radiance of the sun's disc in each band.
std::vector<double> sun_means(std::span<const float> table);

// How bright the sky is: luminance by cells, where `weights` are the bands', and its mean over all directions by bands.
struct SkyBrightness {
  RadianceCells cells;
  std::vector<double> means;
};
SkyBrightness sky_brightness(std::span<const float> table, Vec3 sun, std::span<const double> weights);

}  // namespace accuray
