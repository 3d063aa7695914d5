// Applying an object's transform while lowering, in double precision.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "kernels/math/transform.h"

namespace accuray {

using Matrix = std::array<double, 12>;

inline constexpr Matrix identity_matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

inline std::array<double, 3> transform_vector(const Matrix& m, const std::array<double, 3>& v) {
  return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[4] * v[0] + m[5] * v[1] + m[6] * v[2],
          m[8] * v[0] + m[9] * v[1] + m[10] * v[2]};
}
inline std::array<double, 3> transform_point(const Matrix& m, const std::array<double, 3>& p) {
  const auto v = transform_vector(m, p);
  return {v[0] + m[3], v[1] + m[7], v[2] + m[11]};
}
inline double determinant(const Matrix& m) {
  return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) + m[2] * (m[4] * m[9] - m[5] * m[8]);
}
// Uniform scale: the length of the first column.
inline double scale_of(const Matrix& m) { return std::sqrt(m[0] * m[0] + m[4] * m[4] + m[8] * m[8]); }

inline Transform to_transform(const Matrix& m) {
  Transform t{};
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 4; ++c) t.m[r][c] = static_cast<float>(m[4 * r + c]);
  }
  return t;
}

// Inverse of a rigid transform with uniform scale: transposed linear part over the squared scale.
inline Matrix inverse(const Matrix& m) {
  const double s2 = m[0] * m[0] + m[4] * m[4] + m[8] * m[8];
  Matrix r{};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) r[4 * i + j] = m[4 * j + i] / s2;
    r[4 * i + 3] = -(r[4 * i] * m[3] + r[4 * i + 1] * m[7] + r[4 * i + 2] * m[11]);
  }
  return r;
}

template <bool Point>
inline void transform_array(const Matrix& m, std::span<float> values) {
  for (size_t i = 0; i + 2 < values.size(); i += 3) {
    const std::array<double, 3> v = {values[i], values[i + 1], values[i + 2]};
    const auto w = Point ? transform_point(m, v) : transform_vector(m, v);
    for (size_t k = 0; k < 3; ++k) values[i + k] = static_cast<float>(w[k]);
  }
}

}  // namespace accuray
