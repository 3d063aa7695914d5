// Pixel filters, by filter importance sampling: a sample is drawn from the filter's own density around its pixel and
// counts for that pixel alone with weight 1, so that pixels stay independent (Ernst, Stamminger and Greiner 2006).
// sample(u) inverts one axis: the offset from the pixel's centre, in pixels.
#pragma once

#include "kernels/dispatch.h"
#include "kernels/math/functions.h"
#include "kernels/schema.h"

namespace accuray {

struct BoxFilter {
  float radius;

  static constexpr const char* name = "box";
  static constexpr const char* doc = "The mean over a square.";
  static constexpr auto params() {
    return param_list(Param{.name = "radius",
                            .kind = Kind::real,
                            .doc = "Half width.",
                            .preset = "0.5",
                            .low = 0,
                            .high = 64,
                            .unit = "px",
                            .member = ACCURAY_OFFSET_OF(BoxFilter, radius)});
  }
  float sample(float u) const { return (2.0f * u - 1.0f) * radius; }
};

struct TentFilter {
  float radius;

  static constexpr const char* name = "tent";
  static constexpr const char* doc = "Falls linearly from the centre.";
  static constexpr auto params() {
    return param_list(Param{.name = "radius",
                            .kind = Kind::real,
                            .doc = "Half width.",
                            .preset = "1",
                            .low = 0,
                            .high = 64,
                            .unit = "px",
                            .member = ACCURAY_OFFSET_OF(TentFilter, radius)});
  }
  float sample(float u) const {
    const float x = u < 0.5f ? sqrt(2.0f * u) - 1.0f : 1.0f - sqrt(2.0f * (1.0f - u));
    return x * radius;
  }
};

// Quantiles of a filter, tabulated while lowering; between them linear, so the density is that of the table's cells.
constexpr uint32_t quantile_nodes = 129;

struct Quantiles {
  float node[quantile_nodes];

  float at(float u) const {
    const float t = u * static_cast<float>(quantile_nodes - 1);
    const uint32_t cell = min(static_cast<uint32_t>(t), quantile_nodes - 2);
    return fma(t - static_cast<float>(cell), node[cell + 1] - node[cell], node[cell]);
  }
};

struct GaussianFilter {
  float sigma;
  float radius;
  Quantiles quantiles;  // in units of radius

  static constexpr const char* name = "gaussian";
  static constexpr const char* doc = "A Gaussian cut off at the radius.";
  static constexpr auto params() {
    return param_list(Param{.name = "sigma",
                            .kind = Kind::real,
                            .doc = "Standard deviation.",
                            .preset = "0.5",
                            .low = 0.01,
                            .high = 64,
                            .unit = "px",
                            .member = ACCURAY_OFFSET_OF(GaussianFilter, sigma)},
                      Param{.name = "radius",
                            .kind = Kind::real,
                            .doc = "Half width.",
                            .preset = "2",
                            .low = 0.01,
                            .high = 64,
                            .unit = "px",
                            .member = ACCURAY_OFFSET_OF(GaussianFilter, radius)});
  }
  // Density at t radii from the centre, unnormalised.
  double density(double t) const {
    const double x = t * static_cast<double>(radius) / static_cast<double>(sigma);
    return exp(-0.5 * x * x);
  }
  float sample(float u) const { return quantiles.at(u) * radius; }
};

struct BlackmanHarrisFilter {
  float radius;
  Quantiles quantiles;

  static constexpr const char* name = "blackman_harris";
  static constexpr const char* doc =
      "The four-term window of Harris 1978: close to a Gaussian, exactly zero at its edge.";
  static constexpr auto params() {
    return param_list(Param{.name = "radius",
                            .kind = Kind::real,
                            .doc = "Half width.",
                            .preset = "1.5",
                            .low = 0.01,
                            .high = 64,
                            .unit = "px",
                            .member = ACCURAY_OFFSET_OF(BlackmanHarrisFilter, radius)});
  }
  double density(double t) const {
    const double c1 = sincos(3.14159265358979323846 * t).cos;
    const double c2 = 2.0 * c1 * c1 - 1.0;
    const double c3 = c1 * (2.0 * c2 - 1.0);
    return 0.35875 + 0.48829 * c1 + 0.14128 * c2 + 0.01168 * c3;
  }
  float sample(float u) const { return quantiles.at(u) * radius; }
};

// Fills a filter's table: the trapezoid sum of its density is inverted at equal steps of probability.
template <class Filter>
inline void tabulate(Filter& filter) {
  constexpr int32_t steps = 4096;
  double total = 0.0;
  for (int32_t i = 0; i < steps; ++i) total += filter.density((2.0 * i + 1.0) / steps - 1.0);
  double running = 0.0;
  uint32_t next = 1;
  for (int32_t i = 0; i < steps; ++i) {
    const double share = filter.density((2.0 * i + 1.0) / steps - 1.0) / total;
    while (next < quantile_nodes - 1 && running + share >= static_cast<double>(next) / (quantile_nodes - 1)) {
      const double inside = (static_cast<double>(next) / (quantile_nodes - 1) - running) / share;
      filter.quantiles.node[next++] = static_cast<float>(2.0 * (i + inside) / steps - 1.0);
    }
    running += share;
  }
  filter.quantiles.node[0] = -1.0f;
  filter.quantiles.node[quantile_nodes - 1] = 1.0f;
}

using Filters = TypeList<GaussianFilter, BlackmanHarrisFilter, BoxFilter, TentFilter>;

}  // namespace accuray
