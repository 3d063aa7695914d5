// From descriptions of spectra to the records and tables that kernels read.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kernels/spectrum/rgb.h"
#include "kernels/spectrum/spectrum.h"

namespace accuray {

// Colour data that lowering needs. All arrays are at 360, 361, ... 830 nm.
struct ColourData {
  std::vector<double> cmf;  // 471 x 3, CIE 1931
  std::vector<double> d65;  // 471, scaled to Y = 1
};

class SpectrumPool {
 public:
  explicit SpectrumPool(ColourData colour);

  // The RGB table of lower/rgb_table.h; needed before the first RGB spectrum.
  void set_rgb_table(std::vector<float> scale_nodes, std::vector<float> coefficients);

  SpectrumRef constant(double value);
  // Piecewise linear through (wavelengths[i], values[i]); outside, the end values or zero.
  SpectrumRef table(std::span<const double> wavelengths, std::span<const double> values, bool hold, double scale);
  SpectrumRef rgb_reflectance(double r, double g, double b, double scale);
  // A light of this colour under D65: rgb (1, 1, 1) is D65 with Y = 1.
  SpectrumRef rgb_emission(double r, double g, double b, double scale);
  // Planck's law, W m^-2 sr^-1 nm^-1.
  SpectrumRef blackbody(double kelvin, double scale);
  // n^2 = 1 + a0 + sum b L^2 / (L^2 - c), L in micrometres.
  SpectrumRef sellmeier(double a0, std::span<const double> b, std::span<const double> c, double scale);
  // n = a + b / L^2.
  SpectrumRef cauchy(double a, double b, double scale);

  // A reflectance that a texture gives, times `scale`; it makes the RGB table part of the scene.
  SpectrumRef textured_reflectance(uint32_t texture, double scale);
  // An index that a channel of a texture gives, times `scale` and held within the limits.
  SpectrumRef textured_index(uint32_t texture, uint32_t channel, double scale, double low, double high);
  // A light of a texture's colours under D65, times `scale`, likewise. For value() it is that of the colour white.
  SpectrumRef textured_emission(uint32_t texture, double scale);

  // The same spectrum times a factor.
  SpectrumRef scaled(SpectrumRef ref, double factor);
  // What a light of its own says for each direction, times `scale`. For value() it is that of `means`, at 360 ... 830
  // nm.
  SpectrumRef directional(const std::vector<float>& means, double scale);

  // Position of further values in the tables.
  uint32_t add_table(const std::vector<float>& values);

  double value(SpectrumRef ref, double lambda) const;
  bool is_zero(SpectrumRef ref) const;

  const std::vector<SpectrumRecord>& records() const { return records_; }
  const std::vector<float>& tables() const { return tables_; }
  bool is_textured(SpectrumRef ref) const { return accuray::is_textured(records_[ref.index].form); }
  bool any_textured() const { return any_textured_; }
  const std::vector<float>& rgb_nodes() const { return rgb_nodes_; }
  const std::vector<float>& rgb_table() const { return rgb_coefficients_; }
  const ColourData& colour() const { return colour_; }

 private:
  SpectrumRef add(SpectrumRecord record);
  SpectrumRef add_sampled(const std::vector<double>& values, double step, double scale);
  template <class F>
  SpectrumRef add_function(F&& f, double scale);
  Sigmoid coefficients(double r, double g, double b) const;
  uint32_t d65_table();

  ColourData colour_;
  std::vector<SpectrumRecord> records_;
  std::vector<float> tables_;
  std::vector<float> rgb_nodes_, rgb_coefficients_;
  std::optional<uint32_t> d65_table_;
  bool any_textured_ = false;
};

}  // namespace accuray
