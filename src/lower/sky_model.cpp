#include "lower/sky_model.h"

#include <algorithm>
#include <stdexcept>

#include "kernels/math/functions.h"

namespace accuray {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr size_t kTerms = sky_terms - 1;  // but for the radiance
constexpr uint32_t kWidth = 512;
constexpr uint32_t kHeight = 256;

void check(const SkyData& data) {
  const size_t curves = sky_bands * sky_albedos * sky_turbidities * sky_points;
  if (data.sky.size() != curves * kTerms || data.radiance.size() != curves ||
      data.sun.size() != sky_bands * sky_turbidities * sun_pieces * sun_powers ||
      data.limb.size() != size_t{sky_bands} * SunLight::band_terms) {
    throw std::invalid_argument("the data of the sky have a wrong size");
  }
}

// Cube root of the share of a right angle: how elevations are spaced.
double spaced(double elevation) { return pow(elevation / (0.5 * kPi), 1.0 / 3.0); }

// A Bezier curve of degree 5 through numbers that are `stride` apart.
double bezier(const double* points, size_t stride, double x) {
  constexpr double binomial[sky_points] = {1, 5, 10, 10, 5, 1};
  double sum = 0.0;
  for (size_t k = 0; k < sky_points; ++k) {
    double term = binomial[k] * points[k * stride];
    for (size_t i = 0; i < k; ++i) term *= x;
    for (size_t i = k; i + 1 < sky_points; ++i) term *= 1.0 - x;
    sum += term;
  }
  return sum;
}

// Position between two whole turbidities.
struct Between {
  size_t low, high;  // from 0
  double share;
};
Between between(double turbidity) {
  const auto low = static_cast<size_t>(std::clamp(turbidity, 1.0, 10.0)) - 1;
  return {low, std::min(low + 1, sky_turbidities - 1), turbidity - static_cast<double>(low + 1)};
}

// Linear in turbidity and albedo between what value(albedo, turbidity) gives at their nodes.
template <class Value>
double blended(const Between& turbidity, double albedo, const Value& value) {
  const auto at = [&](size_t a) {
    return (1.0 - turbidity.share) * value(a, turbidity.low) + turbidity.share * value(a, turbidity.high);
  };
  return (1.0 - albedo) * at(0) + albedo * at(1);
}

}  // namespace

std::vector<float> sky_table(const SkyData& data, const SkyConditions& conditions) {
  check(data);
  const double x = spaced(conditions.elevation);
  const Between turbidity = between(conditions.turbidity);
  std::vector<float> table;
  for (size_t band = 0; band < sky_bands; ++band) {
    const auto curve = [&](size_t a, size_t t) {
      return ((band * sky_albedos + a) * sky_turbidities + t) * sky_points;
    };
    const double albedo = conditions.albedo.at(band);
    for (size_t term = 0; term < kTerms; ++term) {
      table.push_back(static_cast<float>(blended(turbidity, albedo, [&](size_t a, size_t t) {
        return bezier(data.sky.data() + curve(a, t) * kTerms + term, kTerms, x);
      })));
    }
    table.push_back(static_cast<float>(blended(
        turbidity, albedo, [&](size_t a, size_t t) { return bezier(data.radiance.data() + curve(a, t), 1, x); })));
  }
  return table;
}

std::vector<float> sun_table(const SkyData& data, const SkyConditions& conditions, double factor) {
  check(data);
  const Between turbidity = between(conditions.turbidity);
  const size_t piece = std::min(sun_pieces - 1, static_cast<size_t>(sun_pieces * spaced(conditions.elevation)));
  const double start = static_cast<double>(piece) / sun_pieces;
  const double beyond = conditions.elevation - start * start * start * 0.5 * kPi;
  std::vector<float> table;
  for (size_t band = 0; band < sky_bands; ++band) {
    const auto cubic = [&](size_t t) {
      const double* c = data.sun.data() + ((band * sky_turbidities + t) * sun_pieces + piece) * sun_powers;
      return ((c[0] * beyond + c[1]) * beyond + c[2]) * beyond + c[3];
    };
    const double middle = (1.0 - turbidity.share) * cubic(turbidity.low) + turbidity.share * cubic(turbidity.high);
    for (size_t i = 0; i < SunLight::band_terms; ++i) {
      table.push_back(static_cast<float>(std::max(middle, 0.0) * factor * data.limb[band * SunLight::band_terms + i]));
    }
  }
  return table;
}

std::vector<double> sun_means(std::span<const float> table) {
  // Over the disc the mean of cosine^i is 2 / (i + 2).
  std::vector<double> means(sky_bands, 0.0);
  for (size_t band = 0; band < sky_bands; ++band) {
    for (size_t i = 0; i < SunLight::band_terms; ++i) {
      means[band] += 2.0 / static_cast<double>(i + 2) * static_cast<double>(table[band * SunLight::band_terms + i]);
    }
  }
  return means;
}

SkyBrightness sky_brightness(std::span<const float> table, Vec3 sun, std::span<const double> weights) {
  SkyBrightness result{{std::vector<float>(size_t{kWidth} * kHeight), kWidth, kHeight},
                       std::vector<double>(sky_bands, 0.0)};
  // Each cell by the middles of its quarters.
  for (uint32_t row = 0; row < kHeight / 2; ++row) {
    const double share = 0.25 * cell_solid_angle(kWidth, kHeight, row) / (4.0 * kPi);
    for (uint32_t column = 0; column < kWidth; ++column) {
      double luminance = 0.0;
      for (uint32_t quarter = 0; quarter < 4; ++quarter) {
        const uint32_t x = 2 * column + quarter % 2;
        const uint32_t y = 2 * row + quarter / 2;
        const Vec2 place = {(static_cast<float>(x) + 0.5f) / (2 * kWidth),
                            (static_cast<float>(y) + 0.5f) / (2 * kHeight)};
        const SkyDirection direction = SkyDirection::of(map_direction(place), sun);
        for (size_t band = 0; band < sky_bands; ++band) {
          const auto radiance = static_cast<double>(sky_radiance(table.data() + band * sky_terms, direction));
          luminance += 0.25 * weights[band] * radiance;
          result.means[band] += share * radiance;
        }
      }
      result.cells.values[size_t{row} * kWidth + column] = static_cast<float>(luminance);
    }
  }
  return result;
}

}  // namespace accuray
