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

// Whether the transform is a rotation or reflection times one scale, plus a translation.
inline bool is_similarity(const Matrix& m) {
  constexpr double tolerance = 1e-5;
  const double s2 = m[0] * m[0] + m[4] * m[4] + m[8] * m[8];
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = i; j < 3; ++j) {
      const double product = m[i] * m[j] + m[4 + i] * m[4 + j] + m[8 + i] * m[8 + j];
      if (!(std::fabs(product - (i == j ? s2 : 0.0)) <= tolerance * s2)) return false;
    }
  }
  return true;
}

// What normals are multiplied with, up to a positive factor: the inverse transposed, made of cofactors.
inline Matrix normal_matrix(const Matrix& m) {
  const double sign = determinant(m) < 0.0 ? -1.0 : 1.0;
  Matrix r{};
  for (size_t i = 0; i < 3; ++i) {
    const size_t a = 4 * ((i + 1) % 3), b = 4 * ((i + 2) % 3);
    for (size_t j = 0; j < 3; ++j) {
      const size_t c = (j + 1) % 3, d = (j + 2) % 3;
      r[4 * i + j] = sign * (m[a + c] * m[b + d] - m[a + d] * m[b + c]);
    }
  }
  return r;
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

// Unit normals under a transform that may shear or stretch.
inline void transform_normals(const Matrix& m, std::span<float> normals) {
  const Matrix n = normal_matrix(m);
  for (size_t i = 0; i + 2 < normals.size(); i += 3) {
    const auto w = transform_vector(n, {normals[i], normals[i + 1], normals[i + 2]});
    const double length = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    for (size_t k = 0; k < 3; ++k) normals[i + k] = static_cast<float>(w[k] / length);
  }
}

}  // namespace accuray
