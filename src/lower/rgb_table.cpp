#include "lower/rgb_table.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <thread>

namespace accuray {
namespace {

constexpr int kLanes = 4;    // partial sums per integral: their order is fixed, so SIMD cannot change a bit
constexpr int kBands = 95;   // 360 to 830 nm in steps of 5 nm
constexpr int kPadded = 96;  // kBands rounded up to whole lanes; the weights of the padding are 0
constexpr int kCmfSamples = 471;
constexpr double kMaxCoefficient = 200.0;
constexpr double kGoodEnough = 1e-4;  // length of the Lab residual at which a fit ends
constexpr int kMaxSteps = 40;

using Vec3 = std::array<double, 3>;
using Mat3 = std::array<Vec3, 3>;

// The quadrature of a reflectance's colour under the illuminant: XYZ_k = sum_i weight[k][i] f(t[i]).
struct Quadrature {
  alignas(64) std::array<double, kPadded> t{};
  alignas(64) std::array<std::array<double, kPadded>, 3> weight{};
  Vec3 white{};
};

Quadrature make_quadrature(std::span<const double> cmf, std::span<const double> illuminant) {
  Quadrature q;
  double y_sum = 0.0;
  for (int i = 0; i < kBands; ++i) y_sum += cmf[static_cast<size_t>(i) * 15 + 1] * illuminant[static_cast<size_t>(i)];
  for (int i = 0; i < kBands; ++i) {
    size_t band = static_cast<size_t>(i);
    q.t[band] = static_cast<double>(i) / (kBands - 1);
    for (size_t k = 0; k < 3; ++k) {
      q.weight[k][band] = cmf[band * 15 + k] * illuminant[band] / y_sum;
      q.white[k] += q.weight[k][band];
    }
  }
  return q;
}

// Cube root of a positive normal number by Newton's method; the C library's differs between machines.
double cube_root(double v) {
  double x = std::bit_cast<double>(std::bit_cast<uint64_t>(v) / 3 + 0x2A9F7893782DA1CEull);  // within 4 %
  for (int i = 0; i < 4; ++i) x -= (x * x * x - v) / (3.0 * x * x);
  return x;
}

// CIE 1976 L*a*b*: the companding function and its derivative at v = X/Xn.
struct Companded {
  double value, slope;
};

Companded compand(double v) {
  constexpr double threshold = 216.0 / 24389.0, toe_slope = 24389.0 / (27.0 * 116.0);
  if (v <= threshold) return {toe_slope * v + 16.0 / 116.0, toe_slope};
  double root = cube_root(v);
  return {root, 1.0 / (3.0 * root * root)};
}

Vec3 to_lab(const Vec3& xyz, const Vec3& white) {
  double x = compand(xyz[0] / white[0]).value, y = compand(xyz[1] / white[1]).value,
         z = compand(xyz[2] / white[2]).value;
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

// Lab distance of a spectrum from its target, with the derivatives by the coefficients.
struct Fit {
  Vec3 residual;
  Mat3 jacobian;
  double squared;
};

// sum_i a[i] b[i], in kLanes interleaved partial sums.
double dot(const std::array<double, kPadded>& a, const std::array<double, kPadded>& b) {
  std::array<double, kLanes> sum{};
  for (size_t i = 0; i < kPadded; i += kLanes) {
    for (size_t lane = 0; lane < kLanes; ++lane) sum[lane] += a[i + lane] * b[i + lane];
  }
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

Fit evaluate(const Quadrature& q, const Vec3& c, const Vec3& target_lab) {
  // Reflectance f and its derivatives by c0, c1, c2: S'(p) (t^2, t, 1), S'(p) = 1/2 (1 + p^2)^(-3/2).
  alignas(64) std::array<double, kPadded> f, by_c0, by_c1, by_c2;
  for (size_t i = 0; i < kPadded; ++i) {
    double t = q.t[i];
    double p = (c[0] * t + c[1]) * t + c[2];
    double r = 1.0 / std::sqrt(1.0 + p * p);
    f[i] = 0.5 + 0.5 * p * r;
    by_c2[i] = 0.5 * r * r * r;
    by_c1[i] = by_c2[i] * t;
    by_c0[i] = by_c1[i] * t;
  }

  std::array<Companded, 3> companded;
  Mat3 slope;  // d companded[k] / d c
  for (size_t k = 0; k < 3; ++k) {
    companded[k] = compand(dot(q.weight[k], f) / q.white[k]);
    double scale = companded[k].slope / q.white[k];
    slope[k] = {scale * dot(q.weight[k], by_c0), scale * dot(q.weight[k], by_c1), scale * dot(q.weight[k], by_c2)};
  }

  Fit fit;
  double x = companded[0].value, y = companded[1].value, z = companded[2].value;
  fit.residual = {116.0 * y - 16.0 - target_lab[0], 500.0 * (x - y) - target_lab[1], 200.0 * (y - z) - target_lab[2]};
  for (size_t j = 0; j < 3; ++j) {
    fit.jacobian[0][j] = 116.0 * slope[1][j];
    fit.jacobian[1][j] = 500.0 * (slope[0][j] - slope[1][j]);
    fit.jacobian[2][j] = 200.0 * (slope[1][j] - slope[2][j]);
  }
  fit.squared =
      fit.residual[0] * fit.residual[0] + fit.residual[1] * fit.residual[1] + fit.residual[2] * fit.residual[2];
  return fit;
}

// Solves a x = b by Cramer's rule; false for a singular matrix.
bool solve(const Mat3& a, const Vec3& b, Vec3& x) {
  auto cross = [](const Vec3& u, const Vec3& v) {
    return Vec3{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  };
  // The normal matrix is symmetric: its rows are its columns.
  Vec3 r0 = cross(a[1], a[2]), r1 = cross(a[2], a[0]), r2 = cross(a[0], a[1]);
  double det = a[0][0] * r0[0] + a[0][1] * r0[1] + a[0][2] * r0[2];
  if (!(std::fabs(det) > 0.0)) return false;
  for (size_t i = 0; i < 3; ++i) x[i] = (b[0] * r0[i] + b[1] * r1[i] + b[2] * r2[i]) / det;
  return true;
}

// Levenberg-Marquardt from `c`; returns the best coefficients met.
Vec3 fit_coefficients(const Quadrature& q, Vec3 c, const Vec3& target_lab) {
  double lambda = 1e-3;
  Fit fit = evaluate(q, c, target_lab);
  for (int step = 0; step < kMaxSteps && fit.squared > kGoodEnough * kGoodEnough; ++step) {
    Mat3 normal{};
    Vec3 gradient{};
    for (size_t k = 0; k < 3; ++k) {
      for (size_t i = 0; i < 3; ++i) {
        gradient[i] += fit.jacobian[k][i] * fit.residual[k];
        for (size_t j = 0; j < 3; ++j) normal[i][j] += fit.jacobian[k][i] * fit.jacobian[k][j];
      }
    }
    for (size_t i = 0; i < 3; ++i) normal[i][i] *= 1.0 + lambda;
    Vec3 change{};
    if (!solve(normal, gradient, change)) break;
    Vec3 candidate{c[0] - change[0], c[1] - change[1], c[2] - change[2]};
    double largest = std::max({std::fabs(candidate[0]), std::fabs(candidate[1]), std::fabs(candidate[2])});
    if (largest > kMaxCoefficient) {
      for (double& v : candidate) v *= kMaxCoefficient / largest;
    }
    Fit next = evaluate(q, candidate, target_lab);
    if (next.squared < fit.squared) {
      c = candidate;
      fit = next;
      lambda *= 0.2;
    } else {
      lambda *= 8.0;
    }
  }
  return c;
}

// Fits all n nodes of the largest component at one (l, y, x), each from its neighbour's solution.
class ColumnFitter {
 public:
  ColumnFitter(int n, const Quadrature& quadrature, const std::array<double, 9>& rgb_to_xyz, std::span<float> table)
      : n_(n), quadrature_(quadrature), m_(rgb_to_xyz), nodes_(rgb_table_scale_nodes(n)), table_(table) {}

  void fit_column(int l, int y, int x) const {
    int start = n_ / 5;
    Vec3 first = fit_node(l, start, y, x, {0.0, 0.0, 0.0});
    Vec3 c = first;
    for (int k = start + 1; k < n_; ++k) c = fit_node(l, k, y, x, c);
    c = first;
    for (int k = start - 1; k >= 0; --k) c = fit_node(l, k, y, x, c);
  }

 private:
  Vec3 fit_node(int l, int k, int y, int x, const Vec3& guess) const {
    double largest = nodes_[static_cast<size_t>(k)];
    Vec3 rgb;
    rgb[static_cast<size_t>(l)] = largest;
    rgb[static_cast<size_t>((l + 1) % 3)] = largest * x / (n_ - 1);
    rgb[static_cast<size_t>((l + 2) % 3)] = largest * y / (n_ - 1);
    Vec3 xyz;
    for (size_t i = 0; i < 3; ++i) xyz[i] = m_[3 * i] * rgb[0] + m_[3 * i + 1] * rgb[1] + m_[3 * i + 2] * rgb[2];

    Vec3 c = fit_coefficients(quadrature_, guess, to_lab(xyz, quadrature_.white));
    size_t node = ((static_cast<size_t>(l * n_ + k) * static_cast<size_t>(n_)) + static_cast<size_t>(y)) *
                      static_cast<size_t>(n_) +
                  static_cast<size_t>(x);
    for (size_t i = 0; i < 3; ++i) table_[node * 3 + i] = static_cast<float>(c[i]);
    return c;
  }

  int n_;
  const Quadrature& quadrature_;
  const std::array<double, 9>& m_;
  std::vector<float> nodes_;
  std::span<float> table_;
};

void check_array(const char* name, std::span<const double> values, size_t size) {
  if (values.size() != size) {
    throw std::invalid_argument("RGB table: " + std::string(name) + " has " + std::to_string(values.size()) +
                                " values, allowed: " + std::to_string(size));
  }
  for (double v : values) {
    if (!std::isfinite(v))
      throw std::invalid_argument("RGB table: " + std::string(name) + " holds a value that is not finite");
  }
}

}  // namespace

std::vector<float> rgb_table_scale_nodes(int n) {
  auto smoothstep = [](double v) { return v * v * (3.0 - 2.0 * v); };
  std::vector<float> nodes(static_cast<size_t>(n));
  for (int k = 0; k < n; ++k) {
    nodes[static_cast<size_t>(k)] = static_cast<float>(smoothstep(smoothstep(static_cast<double>(k) / (n - 1))));
  }
  return nodes;
}

std::vector<float> build_rgb_table(int n, std::span<const double> cmf, std::span<const double> illuminant, int threads,
                                   const std::array<double, 9>& rgb_to_xyz) {
  if (n < 2 || n > 256)
    throw std::invalid_argument("RGB table: " + std::to_string(n) + " nodes per axis, allowed: 2 to 256");
  check_array("the colour matching functions", cmf, static_cast<size_t>(kCmfSamples) * 3);
  check_array("the illuminant", illuminant, kBands);
  check_array("the matrix", rgb_to_xyz, 9);

  Quadrature quadrature = make_quadrature(cmf, illuminant);
  size_t axis = static_cast<size_t>(n);
  std::vector<float> table(3 * axis * axis * axis * 3);
  ColumnFitter fitter(n, quadrature, rgb_to_xyz, table);

  // Columns are independent, so who fits which one changes nothing.
  int columns = 3 * n * n;
  std::atomic<int> next{0};
  auto work = [&] {
    for (int column = next++; column < columns; column = next++) {
      fitter.fit_column(column / (n * n), column / n % n, column % n);
    }
  };
  std::vector<std::jthread> helpers;
  for (int i = 1; i < threads; ++i) helpers.emplace_back(work);
  work();
  helpers.clear();  // joins
  return table;
}

}  // namespace accuray
