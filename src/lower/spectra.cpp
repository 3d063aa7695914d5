#include "lower/spectra.h"

#include <algorithm>
#include <stdexcept>

#include "kernels/math/functions.h"

namespace accuray {

namespace {

// Tables whose nodes are not whole nanometres are sampled ten times as finely.
constexpr double kFineStep = 0.1;  // nm
constexpr size_t kFineCells = size_t{10} * lambda_cells;

// Value at x of the polyline through the nodes.
double interpolate(std::span<const double> xs, std::span<const double> ys, bool hold, double x) {
  if (x < xs.front()) return hold ? ys.front() : 0.0;
  if (x > xs.back()) return hold ? ys.back() : 0.0;
  const auto above = std::upper_bound(xs.begin(), xs.end(), x);
  if (above == xs.end()) return ys.back();
  const size_t i = static_cast<size_t>(above - xs.begin());
  const double t = (x - xs[i - 1]) / (xs[i] - xs[i - 1]);
  return ys[i - 1] + t * (ys[i] - ys[i - 1]);
}

bool whole_nanometres(std::span<const double> xs) {
  return std::all_of(xs.begin(), xs.end(), [](double x) { return x == floor(x); });
}

}  // namespace

SpectrumPool::SpectrumPool(ColourData colour) : colour_(std::move(colour)) {
  if (colour_.cmf.size() != size_t{3} * lambda_nodes || colour_.d65.size() != lambda_nodes) {
    throw std::invalid_argument("colour data must cover 360 to 830 nm in steps of 1 nm");
  }
}

void SpectrumPool::set_rgb_table(std::vector<float> scale_nodes, std::vector<float> coefficients) {
  const size_t n = scale_nodes.size();
  if (n < 2 || coefficients.size() != 9 * n * n * n) throw std::invalid_argument("the RGB table has a wrong size");
  rgb_nodes_ = std::move(scale_nodes);
  rgb_coefficients_ = std::move(coefficients);
}

SpectrumRef SpectrumPool::add(SpectrumRecord record) {
  records_.push_back(record);
  return {static_cast<uint32_t>(records_.size() - 1)};
}

SpectrumRef SpectrumPool::add_sampled(const std::vector<double>& values, double step, double scale) {
  const auto first = static_cast<uint32_t>(tables_.size());
  for (const double v : values) tables_.push_back(static_cast<float>(v));
  const SpectrumForm form = step == 1.0 ? SpectrumForm::table : SpectrumForm::fine;
  return add({form, static_cast<float>(scale), 0, 0, 0, first, static_cast<uint32_t>(values.size()),
              static_cast<float>(step)});
}

template <class F>
SpectrumRef SpectrumPool::add_function(F&& f, double scale) {
  std::vector<double> values(lambda_nodes);
  for (uint32_t i = 0; i < lambda_nodes; ++i) values[i] = f(static_cast<double>(lambda_min) + i);
  return add_sampled(values, 1.0, scale);
}

SpectrumRef SpectrumPool::constant(double value) {
  return add({SpectrumForm::constant, static_cast<float>(value), 0, 0, 0, 0, 0, 0});
}

SpectrumRef SpectrumPool::table(std::span<const double> wavelengths, std::span<const double> values, bool hold,
                                double scale) {
  if (wavelengths.size() != values.size() || wavelengths.empty())
    throw std::invalid_argument("a spectrum needs as many values as wavelengths");
  if (whole_nanometres(wavelengths)) {
    // An end that drops to zero does so within one cell; the table's node beyond the end is zero.
    return add_function([&](double x) { return interpolate(wavelengths, values, hold, x); }, scale);
  }
  std::vector<double> samples(kFineCells + 1);
  for (size_t i = 0; i < samples.size(); ++i) {
    samples[i] =
        interpolate(wavelengths, values, hold, static_cast<double>(lambda_min) + static_cast<double>(i) * kFineStep);
  }
  return add_sampled(samples, kFineStep, scale);
}

Sigmoid SpectrumPool::coefficients(double r, double g, double b) const {
  if (r == g && g == b) return constant_sigmoid(static_cast<float>(r));
  if (rgb_nodes_.empty()) throw std::logic_error("the RGB table was not set");
  const RgbTable view{rgb_nodes_.data(), rgb_coefficients_.data(), static_cast<int32_t>(rgb_nodes_.size())};
  return rgb_coefficients(view, static_cast<float>(r), static_cast<float>(g), static_cast<float>(b));
}

SpectrumRef SpectrumPool::rgb_reflectance(double r, double g, double b, double scale) {
  if (r == g && g == b) return constant(r * scale);
  const Sigmoid c = coefficients(r, g, b);
  return add({SpectrumForm::sigmoid, static_cast<float>(scale), c.c0, c.c1, c.c2, 0, 0, 0});
}

uint32_t SpectrumPool::d65_table() {
  if (!d65_table_) {
    d65_table_ = static_cast<uint32_t>(tables_.size());
    for (const double v : colour_.d65) tables_.push_back(static_cast<float>(v));
  }
  return *d65_table_;
}

SpectrumRef SpectrumPool::rgb_emission(double r, double g, double b, double scale) {
  const double largest = std::max({r, g, b});
  if (largest <= 0.0) return constant(0.0);
  const uint32_t white = d65_table();
  if (r == g && g == b)
    return add({SpectrumForm::table, static_cast<float>(r * scale), 0, 0, 0, white, lambda_nodes, 1});
  // Halfway up, where the sigmoid is smooth (Jakob and Hanika 2019, section 5).
  const double m = 2.0 * largest;
  const Sigmoid c = coefficients(r / m, g / m, b / m);
  return add({SpectrumForm::lit_sigmoid, static_cast<float>(m * scale), c.c0, c.c1, c.c2, white, lambda_nodes, 1});
}

SpectrumRef SpectrumPool::blackbody(double kelvin, double scale) {
  // CODATA 2018: c1L = 2 h c^2, c2 = h c / k; wavelengths in metres, per nanometre at the end.
  constexpr double c1 = 2.0 * 6.62607015e-34 * 2.99792458e8 * 2.99792458e8;
  constexpr double c2 = 6.62607015e-34 * 2.99792458e8 / 1.380649e-23;
  return add_function(
      [&](double nm) {
        const double l = nm * 1e-9;
        const double l2 = l * l;
        return 1e-9 * c1 / (l2 * l2 * l * (exp(c2 / (l * kelvin)) - 1.0));
      },
      scale);
}

SpectrumRef SpectrumPool::sellmeier(double a0, std::span<const double> b, std::span<const double> c, double scale) {
  return add_function(
      [&](double nm) {
        const double l2 = nm * nm * 1e-6;
        double n2 = 1.0 + a0;
        for (size_t i = 0; i < b.size(); ++i) n2 += b[i] * l2 / (l2 - c[i]);
        if (!(n2 > 0.0))
          throw std::invalid_argument("the Sellmeier formula gives no real index at " + std::to_string(nm) + " nm");
        return sqrt(n2);
      },
      scale);
}

SpectrumRef SpectrumPool::cauchy(double a, double b, double scale) {
  return add_function([&](double nm) { return a + b / (nm * nm * 1e-6); }, scale);
}

SpectrumRef SpectrumPool::textured_reflectance(uint32_t texture, double scale) {
  if (rgb_nodes_.empty()) throw std::logic_error("the RGB table was not set");
  any_textured_ = true;
  return add({SpectrumForm::textured, static_cast<float>(scale), 0, 0, 0, texture, 0, 0});
}

SpectrumRef SpectrumPool::textured_index(uint32_t texture, uint32_t channel, double scale, double low, double high) {
  constexpr double most = 3e38;
  return add({SpectrumForm::textured_index, static_cast<float>(scale), static_cast<float>(std::clamp(low, -most, most)),
              static_cast<float>(std::clamp(high, -most, most)), 0, texture, channel, 0});
}

SpectrumRef SpectrumPool::textured_emission(uint32_t texture, double scale) {
  if (rgb_nodes_.empty()) throw std::logic_error("the RGB table was not set");
  any_textured_ = true;
  return add({SpectrumForm::textured_emission, static_cast<float>(scale), 0, 0, 0, d65_table(), texture, 1});
}

SpectrumRef SpectrumPool::scaled(SpectrumRef ref, double factor) {
  SpectrumRecord record = records_.at(ref.index);
  record.scale = static_cast<float>(static_cast<double>(record.scale) * factor);
  return add(record);
}

SpectrumRef SpectrumPool::directional(const std::vector<float>& means, double scale) {
  return add({SpectrumForm::directional, static_cast<float>(scale), 0, 0, 0, add_table(means), lambda_nodes, 1});
}

uint32_t SpectrumPool::add_table(const std::vector<float>& values) {
  const auto first = static_cast<uint32_t>(tables_.size());
  tables_.insert(tables_.end(), values.begin(), values.end());
  return first;
}

double SpectrumPool::value(SpectrumRef ref, double lambda) const {
  const Wavelengths wl = Wavelengths::at(lanes(static_cast<float>(lambda)), lanes(1.0f));
  return static_cast<double>(evaluate(records_[ref.index], tables_.data(), wl)[0]);
}

bool SpectrumPool::is_zero(SpectrumRef ref) const {
  for (uint32_t i = 0; i < lambda_nodes; ++i) {
    if (value(ref, static_cast<double>(lambda_min) + i) != 0.0) return false;
  }
  const SpectrumRecord& s = records_[ref.index];
  if (s.form != SpectrumForm::fine) return true;
  return std::all_of(tables_.begin() + s.table, tables_.begin() + s.table + s.count, [](float v) { return v == 0.0f; });
}

}  // namespace accuray
