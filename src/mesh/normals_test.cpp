#include "mesh/normals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace accuray::mesh {
namespace {

using Floats = std::vector<float>;
using Indices = std::vector<uint32_t>;

void expect_near(const Floats& actual, const Floats& expected, float tolerance = 1e-6f) {
  ASSERT_EQ(actual.size(), expected.size());
  for (size_t i = 0; i < actual.size(); ++i) EXPECT_NEAR(actual[i], expected[i], tolerance) << i;
}

// A corner of a cube, of one square and one triangle per remaining side, at the origin; the square cut either way.
TEST(Normals, DoNotDependOnHowAFaceIsCut) {
  const Floats positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, -1};
  const Indices sides = {0, 4, 1, 0, 3, 4};
  for (const Indices& square : {Indices{0, 1, 2, 0, 2, 3}, Indices{0, 1, 3, 1, 2, 3}}) {
    Indices indices = sides;
    indices.insert(indices.end(), square.begin(), square.end());
    Floats corner = smooth_normals(positions, indices);
    corner.resize(3);
    float s = 1.0f / std::sqrt(3.0f);
    expect_near(corner, {-s, -s, s});
  }
}

TEST(Normals, OfASphereAreRadial) {
  constexpr uint32_t rings = 24, sectors = 48;
  Floats positions;
  Indices indices;
  for (uint32_t i = 0; i <= rings; ++i) {
    for (uint32_t j = 0; j <= sectors; ++j) {  // the last column repeats the first: a seam
      double theta = M_PI * i / rings, phi = 2.0 * M_PI * (j % sectors) / sectors;
      double ring = i == 0 || i == rings ? 0.0 : std::sin(theta);
      for (double x : {ring * std::cos(phi), std::cos(theta), ring * std::sin(phi)}) {
        positions.push_back(static_cast<float>(x));
      }
    }
  }
  for (uint32_t i = 0; i < rings; ++i) {
    for (uint32_t j = 0; j < sectors; ++j) {
      uint32_t a = i * (sectors + 1) + j, b = a + sectors + 1;
      if (i > 0) indices.insert(indices.end(), {a, a + 1, b});
      if (i + 1 < rings) indices.insert(indices.end(), {a + 1, b + 1, b});
    }
  }
  Floats normals = smooth_normals(positions, indices);
  double worst = 1.0;
  for (size_t i = 0; i < normals.size(); i += 3) {
    worst = std::min(worst, double{normals[i]} * positions[i] + double{normals[i + 1]} * positions[i + 1] +
                                double{normals[i + 2]} * positions[i + 2]);
  }
  EXPECT_GT(worst, std::cos(0.02));
  // Both sides of the seam agree to the bit.
  for (size_t i = 0; i <= rings; ++i) {
    size_t first = 3 * i * (sectors + 1), last = first + size_t{3} * sectors;
    for (size_t j = 0; j < 3; ++j) EXPECT_EQ(normals[first + j], normals[last + j]);
  }
}

TEST(Normals, DoNotDependOnTheScale) {
  const Floats unit = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const Indices indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  Floats expected = smooth_normals(unit, indices);
  for (float scale : {1e-9f, 1e-6f, 1e5f, 1e17f}) {
    Floats scaled = unit;
    for (float& x : scaled) x *= scale;
    expect_near(smooth_normals(scaled, indices), expected);
  }
}

TEST(Normals, TwoSidesOfALeafDoNotCancel) {
  const Floats leaf = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  Floats twice = leaf;
  twice.insert(twice.end(), leaf.begin(), leaf.end());
  expect_near(smooth_normals(twice, Indices{0, 1, 2, 3, 5, 4}),
              {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, -1, 0, 0, -1});
  // With shared vertices one of the two sides is taken.
  for (float z : smooth_normals(leaf, Indices{0, 1, 2, 0, 2, 1})) EXPECT_TRUE(z == 0.0f || std::fabs(z) == 1.0f);
}

TEST(Normals, OfVerticesWithoutTriangles) {
  expect_near(smooth_normals(Floats{0, 0, 0, 1, 1, 1}, Indices{}), {0, 1, 0, 0, 1, 0});
  EXPECT_TRUE(smooth_normals(Floats{}, Indices{}).empty());
}

}  // namespace
}  // namespace accuray::mesh
