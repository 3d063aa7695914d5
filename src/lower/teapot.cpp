#include "lower/teapot.h"

#include <stdexcept>

#include "lower/grid.h"

namespace accuray {

namespace {

constexpr size_t patches = 32;
constexpr size_t patch_points = 16;
constexpr double newell_height = 3.15;

using Weights = std::array<double, 4>;

// Cubic Bernstein polynomials at k / n, and their derivatives by it. Both are symmetric to the last bit, so that
// patches which share an edge in opposite directions share its points.
Weights bernstein(uint32_t k, uint32_t n) {
  const double t = static_cast<double>(k) / n;
  const double s = static_cast<double>(n - k) / n;
  return {s * s * s, 3.0 * (s * t * s), 3.0 * (s * t * t), t * t * t};
}
Weights bernstein_slope(uint32_t k, uint32_t n) {
  const double t = static_cast<double>(k) / n;
  const double s = static_cast<double>(n - k) / n;
  return {-3.0 * s * s, 3.0 * (s * s - 2.0 * (s * t)), 3.0 * (2.0 * (s * t) - t * t), 3.0 * t * t};
}

double blended(const Weights& w, double a, double b, double c, double d) {
  return (w[0] * a + w[3] * d) + (w[1] * b + w[2] * c);
}

using Patch = std::array<Double3, patch_points>;

// The tensor product of weights in v (rows) and u (columns).
Double3 blended(const Patch& patch, const Weights& v, const Weights& u) {
  Double3 result{};
  for (size_t axis = 0; axis < 3; ++axis) {
    Weights row{};
    for (size_t i = 0; i < 4; ++i) {
      row[i] = blended(u, patch[4 * i][axis], patch[4 * i + 1][axis], patch[4 * i + 2][axis], patch[4 * i + 3][axis]);
    }
    result[axis] = blended(v, row[0], row[1], row[2], row[3]);
  }
  return result;
}

// Scaled, and turned from +Z up to +Y up.
Patch upright_patch(const double* points, double scale) {
  Patch patch{};
  for (size_t i = 0; i < patch_points; ++i) {
    const double* p = points + 3 * i;
    patch[i] = {scale * p[0], scale * p[2], -scale * p[1]};
  }
  return patch;
}

void add_patch(mesh::MeshData& mesh, const Patch& patch, const Double3& center, uint32_t n, bool smooth) {
  const bool pole = patch[0] == patch[1] && patch[1] == patch[2] && patch[2] == patch[3];
  add_grid(mesh, n, n, smooth, pole, [&](uint32_t i, uint32_t j) {
    const Weights u = bernstein(i, n);
    const Weights v = bernstein(j, n);
    const Weights du = bernstein_slope(i, n);
    const Weights dv = bernstein_slope(j, n);
    // At the pole dp/du vanishes in proportion to v, so its direction there is that of the mixed derivative.
    const Double3 along_u = blended(patch, pole && j == 0 ? dv : v, du);
    return GridPoint{sum(center, blended(patch, v, u)), cross(along_u, blended(patch, dv, u))};
  });
}

}  // namespace

mesh::MeshData teapot_mesh(std::span<const double> newell, const Double3& center, double height, uint32_t segments,
                           bool smooth) {
  if (newell.size() != patches * patch_points * 3)
    throw std::invalid_argument("the teapot has 32 patches of 16 points");
  mesh::MeshData mesh;
  for (size_t k = 0; k < patches; ++k) {
    const double* points = newell.data() + 3 * patch_points * k;
    add_patch(mesh, upright_patch(points, height / newell_height), center, segments, smooth);
  }
  return mesh;
}

}  // namespace accuray
