// RGB to reflectance: smooth spectra from three numbers (Jakob and Hanika 2019).
//
//   f(lambda) = S(c0 t^2 + c1 t + c2),   t = (lambda - 360 nm) / 470 nm,   S(x) = 1/2 + x / (2 sqrt(1 + x^2))
//
// f lies within [0, 1] for all coefficients, so no upsampled reflectance creates energy. The coefficients of an RGB
// triple come from a table that `lower/rgb_table.h` builds; this header looks them up and evaluates them.
//
// The polynomial is kept in t, not in nanometres: in float its terms then stay of the size of their sum, whereas
// coefficients per nm^2 and nm lose about three digits to cancellation.
#pragma once

#include "kernels/math/interval.h"
#include "kernels/port.h"

namespace accuray {

// Coefficients of t^2, t and 1 of one reflectance spectrum.
struct Sigmoid {
  float c0, c1, c2;
};

// A table as `build_rgb_table` lays it out; it owns nothing.
// scale_nodes: n increasing values from 0 to 1, the nodes of the largest component.
// coefficients: float [3][n][n][n][3], indexed by (index of the largest component l; node of component l; node of
// component (l+2)%3 relative to l; node of component (l+1)%3 relative to l; coefficient). Relative nodes are i/(n-1).
struct RgbTable {
  const float* scale_nodes;
  const float* coefficients;
  int32_t n;
};

// Reflectance at a wavelength in nm (used within 360 to 830). For x < 0 the textbook form 1/2 + x/(2 s), s =
// sqrt(1+x^2), cancels: a reflectance of 1e-6 would be wrong by 3 %. Both signs go through the small tail
// 1/(2 s (s+|x|)) instead, which is exact to rounding.
inline float sigmoid_eval(float c0, float c1, float c2, float lambda) {
  float t = (lambda - 360.0f) * (1.0f / 470.0f);
  float x = fma(fma(c0, t, c1), t, c2);
  float s = sqrt(fma(x, x, 1.0f));
  float tail = 0.5f / (s * (s + abs(x)));
  return x < 0.0f ? tail : 1.0f - tail;
}

inline float sigmoid_eval(const Sigmoid& c, float lambda) { return sigmoid_eval(c.c0, c.c1, c.c2, lambda); }

// The constant spectrum of reflectance v in [0, 1]; exactly 0 and 1 at the ends: 1.5e19 squared is still finite, so
// x/s is exactly +-1, while s (s+|x|) overflows to a tail of exactly 0.
inline Sigmoid constant_sigmoid(float v) {
  constexpr float huge = 1.5e19f;
  if (!(v > 0.0f)) return {0.0f, 0.0f, -huge};
  if (v >= 1.0f) return {0.0f, 0.0f, huge};
  return {0.0f, 0.0f, (v - 0.5f) / sqrt(v * (1.0f - v))};
}

namespace rgb_lookup {

// A position on a node axis: between `node` and `node + 1`, at `fraction` of the way.
struct Cell {
  int32_t node;
  float fraction;
};

// Cell of a relative component v in [0, 1] on n equal nodes.
inline Cell uniform_cell(float v, int32_t n) {
  float position = v * static_cast<float>(n - 1);
  int32_t node = static_cast<int32_t>(position);
  if (node > n - 2) node = n - 2;
  return {node, position - static_cast<float>(node)};
}

// Cell of v in [0, 1] on the increasing nodes, by bisection.
inline Cell scale_cell(const float* nodes, int32_t n, float v) {
  const auto low = static_cast<int32_t>(interval_of(nodes, static_cast<uint32_t>(n - 1), v));
  return {low, (v - nodes[low]) / (nodes[low + 1] - nodes[low])};
}

inline float clamp_unit(float v) { return v > 0.0f ? (v < 1.0f ? v : 1.0f) : 0.0f; }  // NaN becomes 0

inline float mix(float a, float b, float u) { return a + u * (b - a); }

// Bilinear value at `corner`, whose neighbours in x are 3 values on and those in y one row.
inline float bilinear(const float* corner, uint64_t row, float x, float y) {
  return mix(mix(corner[0], corner[3], x), mix(corner[row], corner[row + 3], x), y);
}

}  // namespace rgb_lookup

// Coefficients of a reflectance whose colour under the table's illuminant is (r, g, b); components are clamped to
// [0, 1]. Equal components give the constant spectrum exactly. n must be at least 2.
inline Sigmoid rgb_coefficients(const RgbTable& table, float r, float g, float b) {
  r = rgb_lookup::clamp_unit(r);
  g = rgb_lookup::clamp_unit(g);
  b = rgb_lookup::clamp_unit(b);
  if (r == g && g == b) return constant_sigmoid(r);

  int32_t l = r >= g ? (r >= b ? 0 : 2) : (g >= b ? 1 : 2);
  float largest = l == 0 ? r : l == 1 ? g : b;
  float next = l == 0 ? g : l == 1 ? b : r;
  float after = l == 0 ? b : l == 1 ? r : g;

  int32_t n = table.n;
  rgb_lookup::Cell z = rgb_lookup::scale_cell(table.scale_nodes, n, largest);
  rgb_lookup::Cell y = rgb_lookup::uniform_cell(after / largest, n);
  rgb_lookup::Cell x = rgb_lookup::uniform_cell(next / largest, n);

  uint64_t row = static_cast<uint64_t>(n) * 3;
  const float* corner = table.coefficients + static_cast<uint64_t>((l * n + z.node) * n + y.node) * row +
                        static_cast<uint64_t>(x.node) * 3;
  uint64_t slice = row * static_cast<uint64_t>(n);
  float c[3];
  for (int32_t i = 0; i < 3; ++i) {
    float low = rgb_lookup::bilinear(corner + i, row, x.fraction, y.fraction);
    float high = rgb_lookup::bilinear(corner + i + slice, row, x.fraction, y.fraction);
    c[i] = rgb_lookup::mix(low, high, z.fraction);
  }
  return {c[0], c[1], c[2]};
}

}  // namespace accuray
