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

// A strip of four squares along x whose edges bend by 30 degrees and by 60 in turn.
struct Strip {
  Floats positions;
  Indices indices;
  Strip() {
    double x = 0.0, y = 0.0, angle = 0.0;
    for (uint32_t i = 0; i < 5; ++i) {
      for (float z : {0.0f, 1.0f}) positions.insert(positions.end(), {float(x), float(y), z});
      x += std::cos(angle), y += std::sin(angle);
      angle += (i % 2 == 0 ? 30.0 : 60.0) * M_PI / 180.0;
      if (i > 0) indices.insert(indices.end(), {2 * i - 2, 2 * i - 1, 2 * i, 2 * i, 2 * i - 1, 2 * i + 1});
    }
  }
};

TEST(CreasedNormals, AreSmoothAcrossBluntEdgesOnly) {
  const Strip strip;
  auto count = [&](double degrees) {
    return creased_normals(strip.positions, strip.indices, {}, std::cos(degrees * M_PI / 180.0)).source.size();
  };
  EXPECT_EQ(count(10.0), 16u);  // each square has its own corners; the two triangles of a square share two
  EXPECT_EQ(count(45.0), 12u);  // one of three bent edges stays sharp
  EXPECT_EQ(count(70.0), 10u);
  const CreasedMesh mesh = creased_normals(strip.positions, strip.indices, {}, std::cos(M_PI / 4));
  ASSERT_EQ(mesh.indices.size(), strip.indices.size());
  for (size_t i = 0; i < mesh.indices.size(); ++i) EXPECT_EQ(mesh.source[mesh.indices[i]], strip.indices[i]);
  const size_t at = mesh.indices[2];  // between the first two squares, which lie at 0 and 30 degrees
  EXPECT_NEAR(std::fabs(mesh.normals[3 * at]), std::sin(M_PI / 12), 1e-6);
  EXPECT_NEAR(std::fabs(mesh.normals[3 * at + 1]), std::cos(M_PI / 12), 1e-6);
}

TEST(CreasedNormals, OfEverySmoothEdgeAreTheSmoothOnes) {
  const Strip strip;
  const CreasedMesh mesh = creased_normals(strip.positions, strip.indices, {}, -2.0);
  const Floats smooth = smooth_normals(strip.positions, strip.indices);
  ASSERT_EQ(mesh.source.size(), strip.positions.size() / 3);
  for (size_t i = 0; i < mesh.source.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(mesh.normals[3 * i + k], smooth[3 * size_t{mesh.source[i]} + k], 1e-6);
  }
}

TEST(CreasedNormals, GroupZeroIsFlat) {
  const Strip strip;
  const Indices groups = {0, 0, 1, 1, 1, 1, 2, 2};
  const CreasedMesh mesh = creased_normals(strip.positions, strip.indices, groups, -2.0);
  EXPECT_EQ(mesh.source.size(), 6u + 6u + 4u);  // two triangles apart, two squares together, one by itself
}

TEST(CreasedNormals, SurviveManyTrianglesAtOneEdge) {
  Floats positions = {0, 0, 0, 0, 0, 1};
  Indices indices;
  for (uint32_t i = 0; i < 20000; ++i) {
    positions.insert(positions.end(), {std::cos(float(i)), std::sin(float(i)), 0.0f});
    indices.insert(indices.end(), {0, 1, i + 2});
  }
  const CreasedMesh mesh = creased_normals(positions, indices, {}, 0.5);
  for (size_t i = 0; i < mesh.normals.size(); i += 3) {
    ASSERT_NEAR(std::hypot(mesh.normals[i], mesh.normals[i + 1], mesh.normals[i + 2]), 1.0, 1e-6);
  }
}

}  // namespace
}  // namespace accuray::mesh
