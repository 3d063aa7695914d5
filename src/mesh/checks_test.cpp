#include "mesh/checks.h"

#include <limits>

#include "mesh/test_support.h"

namespace accuray::mesh {
namespace {

using Floats = std::vector<float>;
using Indices = std::vector<uint32_t>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Whether a triangle survives.
bool keeps(const Floats& positions) {
  MeshData mesh;
  mesh.positions = positions;
  mesh.indices = {0, 1, 2};
  repair(mesh);
  expect_valid(mesh);
  return mesh.indices.size() == 3;
}

TEST(Checks, TinyAndHugeTrianglesAreKept) {
  for (float scale : {1e-38f, 1e-20f, 1e-9f, 1e-6f, 1.0f, 1e6f, 1e18f}) {
    EXPECT_TRUE(keeps({0, 0, 0, scale, 0, 0, 0, scale, 0})) << scale;
    EXPECT_TRUE(keeps({0, 0, 0, scale, 0, 0, scale, scale * 1e-6f, 0})) << scale;
  }
  // A micrometre triangle a kilometre away, one float step wide.
  float x = 1000.0f, next = std::nextafter(x, 2000.0f);
  EXPECT_TRUE(keeps({x, 0, 0, next, 0, 0, x, 1e-6f, 0}));
  // A needle: one vertex far from the two others.
  EXPECT_TRUE(keeps({0, 0, 0, 1e-16f, 0, 0, 0, 1, 0}));
}

TEST(Checks, TrianglesWithoutAreaAreDropped) {
  EXPECT_FALSE(keeps({1, 2, 3, 1, 2, 3, 4, 5, 6}));
  EXPECT_FALSE(keeps({1, 2, 3, 4, 5, 6, 1, 2, 3}));
  EXPECT_FALSE(keeps({1, 2, 3, 1, 2, 3, 1, 2, 3}));
  EXPECT_FALSE(keeps({0, 0, 0, -0.0f, 0, 0, 1, 0, 0}));
  for (float scale : {1e-30f, 1e-6f, 1.0f, 1e17f}) {
    EXPECT_FALSE(keeps({0, 0, 0, scale, 2 * scale, -scale, 3 * scale, 6 * scale, -3 * scale})) << scale;
  }
}

TEST(Checks, TrianglesBeyondTheRangeAreDropped) {
  for (float bad : {kNan, kInfinity, -kInfinity, 1.1e18f, -1e30f}) {
    for (size_t i = 0; i < 9; ++i) {
      Floats positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
      positions[i] = bad;
      EXPECT_FALSE(keeps(positions)) << bad << " " << i;
    }
  }
}

TEST(Checks, AttributesFollowTheirVertices) {
  MeshData mesh;
  mesh.positions = {kNan, 0, 0, 0, 0, 0, 9, 9, 9, 1, 0, 0, 0, 1, 0};
  mesh.normals = {1, 0, 0, 0, 0, 2, 0, 1, 0, 0, kNan, 0, 0, 0, 0};
  mesh.uvs = {0, 0, 1, 1, 2, 2, 3, kInfinity, 4, 4};
  mesh.indices = {0, 1, 3, 1, 3, 4};
  repair(mesh);
  expect_valid(mesh);
  EXPECT_EQ(mesh.positions, (Floats{0, 0, 0, 1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(mesh.normals, (Floats{0, 0, 1, 0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(mesh.uvs, (Floats{1, 1, 0, 0, 4, 4}));
  EXPECT_EQ(mesh.indices, (Indices{0, 1, 2}));
  EXPECT_EQ(mesh.report.nonfinite_vertices, 1u);
  EXPECT_EQ(mesh.report.nonfinite_triangles, 1u);
  EXPECT_EQ(mesh.report.generated_normals, 2u);
  EXPECT_EQ(mesh.report.missing_uvs, 1u);
}

TEST(Checks, IndicesInRange) {
  MeshData mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  mesh.indices = {0, 1, 2, 2, 1, 0};
  EXPECT_NO_THROW(require_indices_in_range(mesh, "shapes.a"));
  mesh.indices[4] = 3;
  auto check = [&] {
    require_indices_in_range(mesh, "shapes.a");
    return mesh;
  };
  expect_error(check, "shapes.a: vertex index of triangle 1 '3' is out of range: allowed 0 to 2");
  mesh.positions.clear();
  expect_error(check,
               "shapes.a: vertex index of triangle 0 '0' is out of range: allowed none, for there are no vertices");
}

}  // namespace
}  // namespace accuray::mesh
