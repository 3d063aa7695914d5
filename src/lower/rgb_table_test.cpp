#include "lower/rgb_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>

#include "kernels/spectrum/rgb.h"

namespace accuray {
namespace {

using Rgb = std::array<double, 3>;

// A CSV file of accuray/data without its comment and its column names; all but the first column, row by row.
std::vector<std::vector<double>> read_csv(const std::string& name) {
  std::ifstream file(ACCURAY_DATA "/" + name);
  EXPECT_TRUE(file) << "cannot read " << name;
  std::vector<std::vector<double>> rows;
  std::string line, cell;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] < '0' || line[0] > '9') continue;
    rows.emplace_back();
    std::istringstream cells(line);
    while (std::getline(cells, cell, ',')) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

struct Fixture {
  std::vector<double> cmf, d65;
  std::vector<float> nodes, coefficients;

  RgbTable view() const { return {nodes.data(), coefficients.data(), static_cast<int32_t>(nodes.size())}; }
};

// The CIE data and the renderer's table, made once.
const Fixture& fixture() {
  static const Fixture made = [] {
    Fixture f;
    for (const auto& row : read_csv("cie1931_2deg_1nm.csv")) f.cmf.insert(f.cmf.end(), row.begin() + 1, row.end());
    for (const auto& row : read_csv("cie_illuminants_300_830_5nm.csv")) {
      if (row[0] >= 360.0) f.d65.push_back(row[3]);
    }
    f.nodes = rgb_table_scale_nodes(kRgbTableNodes);
    f.coefficients = build_rgb_table(kRgbTableNodes, f.cmf, f.d65, 2);
    return f;
  }();
  return made;
}

Rgb lab(const Rgb& xyz, const Rgb& white) {
  Rgb f;
  for (size_t i = 0; i < 3; ++i) {
    double v = xyz[i] / white[i];
    f[i] = v > 216.0 / 24389.0 ? std::cbrt(v) : (24389.0 / 27.0 * v + 16.0) / 116.0;
  }
  return {116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])};
}

// CIE 1976 colour difference between a spectrum under D65, summed at 1 nm, and the colour it stands for. The table is
// fitted at 5 nm, so this is no repetition of its own sum.
double delta_e(const Sigmoid& spectrum, const Rgb& rgb) {
  const Fixture& f = fixture();
  Rgb xyz{}, white{}, target{};
  for (size_t i = 0; i <= 470; ++i) {
    size_t band = std::min<size_t>(i / 5, 93);
    double light = std::lerp(f.d65[band], f.d65[band + 1], static_cast<double>(i) / 5.0 - static_cast<double>(band));
    double reflectance = sigmoid_eval(spectrum, 360.0f + static_cast<float>(i));
    for (size_t k = 0; k < 3; ++k) {
      white[k] += f.cmf[3 * i + k] * light;
      xyz[k] += f.cmf[3 * i + k] * light * reflectance;
    }
  }
  double scale = 1.0 / white[1];
  for (size_t k = 0; k < 3; ++k) {
    xyz[k] *= scale;
    white[k] *= scale;
    for (size_t j = 0; j < 3; ++j) target[k] += kRec709ToXyz[3 * k + j] * rgb[j];
  }
  Rgb a = lab(xyz, white), b = lab(target, white);
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

uint64_t fnv1a(const std::vector<float>& values) {
  uint64_t hash = 0xCBF29CE484222325u;
  for (float value : values) {
    uint32_t bits = std::bit_cast<uint32_t>(value);
    for (int i = 0; i < 4; ++i, bits >>= 8) hash = (hash ^ (bits & 0xFFu)) * 0x100000001B3u;
  }
  return hash;
}

Sigmoid look_up(double r, double g, double b) {
  return rgb_coefficients(fixture().view(), static_cast<float>(r), static_cast<float>(g), static_cast<float>(b));
}

TEST(RgbTable, NodesReproduceTheirColours) {
  const Fixture& f = fixture();
  int n = kRgbTableNodes, bad = 0, count = 0;
  double worst = 0.0;
  for (int l = 0; l < 3; ++l) {
    for (int k = 0; k < n; ++k) {
      for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x, ++count) {
          Rgb rgb;
          double largest = f.nodes[static_cast<size_t>(k)];
          rgb[static_cast<size_t>(l)] = largest;
          rgb[static_cast<size_t>((l + 1) % 3)] = largest * x / (n - 1);
          rgb[static_cast<size_t>((l + 2) % 3)] = largest * y / (n - 1);
          const float* c = &f.coefficients[static_cast<size_t>(count) * 3];
          double error = delta_e({c[0], c[1], c[2]}, rgb);
          worst = std::max(worst, error);
          bad += error >= 1.0 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_LE(bad, count / 200) << "of " << count;
  EXPECT_LT(worst, 2.0);
}

TEST(RgbTable, InterpolatedColoursComeBack) {
  std::mt19937_64 random(1);
  std::vector<double> errors;
  for (int i = 0; i < 10000; ++i) {
    Rgb rgb;
    for (double& v : rgb) v = static_cast<double>(random() >> 40) * 0x1p-24;  // exact in float
    errors.push_back(delta_e(look_up(rgb[0], rgb[1], rgb[2]), rgb));
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[9900], 1.0);
  EXPECT_LT(errors[5000], 0.15);
}

// Bits of the whole table: a change of compiler, flags or method shows here.
TEST(RgbTable, BitsArePinned) { EXPECT_EQ(fnv1a(fixture().coefficients), 13663896691443775627u); }

TEST(RgbTable, ThreadsChangeNothing) {
  const Fixture& f = fixture();
  EXPECT_EQ(build_rgb_table(6, f.cmf, f.d65, 1), build_rgb_table(6, f.cmf, f.d65, 5));
}

TEST(RgbTable, LookupAtNodesIsTheNode) {
  const Fixture& f = fixture();
  size_t n = kRgbTableNodes, k = 20, y = 7, x = 11;
  double largest = f.nodes[k], step = 1.0 / static_cast<double>(n - 1);
  // Green is largest, blue is next.
  Sigmoid c = look_up(largest * static_cast<double>(y) * step, largest, largest * static_cast<double>(x) * step);
  const float* node = &f.coefficients[((n + k) * n + y) * n * 3 + x * 3];
  EXPECT_FLOAT_EQ(c.c0, node[0]);
  EXPECT_FLOAT_EQ(c.c1, node[1]);
  EXPECT_FLOAT_EQ(c.c2, node[2]);
}

TEST(RgbTable, GreysAreConstantAndTheEndsExact) {
  for (float v : {1e-6f, 0.001f, 0.18f, 0.5f, 0.9f, 0.999999f}) {
    Sigmoid c = look_up(v, v, v);
    EXPECT_EQ(c.c0, 0.0f);
    EXPECT_EQ(c.c1, 0.0f);
    for (float lambda : {360.0f, 555.0f, 830.0f}) EXPECT_NEAR(sigmoid_eval(c, lambda), v, 3e-7f * v);
  }
  for (float lambda : {360.0f, 500.0f, 830.0f}) {
    EXPECT_EQ(sigmoid_eval(look_up(0, 0, 0), lambda), 0.0f);
    EXPECT_EQ(sigmoid_eval(look_up(1, 1, 1), lambda), 1.0f);
  }
}

TEST(RgbTable, ComponentsAreClamped) {
  auto expect_same = [](const Sigmoid& a, const Sigmoid& b) {
    EXPECT_EQ(a.c0, b.c0);
    EXPECT_EQ(a.c1, b.c1);
    EXPECT_EQ(a.c2, b.c2);
  };
  double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  expect_same(look_up(-1, 0.5, 2), look_up(0, 0.5, 1));
  expect_same(look_up(nan, infinity, -infinity), look_up(0, 1, 0));
  expect_same(look_up(nan, nan, nan), look_up(0, 0, 0));
}

TEST(RgbTable, ReflectancesStayWithinZeroAndOne) {
  for (double r : {0.0, 1e-30, 1e-6, 0.3, 1.0}) {
    for (double g : {0.0, 1e-20, 1e-3, 0.7, 1.0}) {
      for (double b : {0.0, 1e-8, 0.5, 0.999, 1.0}) {
        Sigmoid c = look_up(r, g, b);
        for (int lambda = 360; lambda <= 830; lambda += 10) {
          float f = sigmoid_eval(c, static_cast<float>(lambda));
          ASSERT_TRUE(f >= 0.0f && f <= 1.0f) << r << " " << g << " " << b << " at " << lambda << ": " << f;
        }
      }
    }
  }
}

// The tail form keeps its relative accuracy where 1/2 + x / (2 sqrt(1 + x^2)) in float has none left.
TEST(RgbTable, DarkReflectancesAreAccurate) {
  for (double x : {-0.001, -1.0, -30.0, -500.0, -20000.0}) {
    double s = std::sqrt(1.0 + x * x), exact = 0.5 / (s * (s - x));
    EXPECT_NEAR(sigmoid_eval(0.0f, 0.0f, static_cast<float>(x), 500.0f) / exact, 1.0, 1e-6) << x;
    EXPECT_NEAR(sigmoid_eval(0.0f, 0.0f, static_cast<float>(-x), 500.0f), 1.0 - exact, 1e-7) << x;
  }
}

TEST(RgbTable, BadInputIsRefused) {
  const Fixture& f = fixture();
  EXPECT_THROW(build_rgb_table(1, f.cmf, f.d65, 1), std::invalid_argument);
  EXPECT_THROW(build_rgb_table(257, f.cmf, f.d65, 1), std::invalid_argument);
  EXPECT_THROW(build_rgb_table(4, std::span(f.cmf).first(1410), f.d65, 1), std::invalid_argument);
  EXPECT_THROW(build_rgb_table(4, f.cmf, std::span(f.d65).first(94), 1), std::invalid_argument);
  std::vector<double> broken = f.d65;
  broken[17] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(build_rgb_table(4, f.cmf, broken, 1), std::invalid_argument);
}

}  // namespace
}  // namespace accuray
