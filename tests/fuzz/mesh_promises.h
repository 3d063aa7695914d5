// What a fuzz target asks of every mesh that a reader returns.
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "mesh/error.h"
#include "mesh/mesh.h"

namespace accuray::mesh {

inline void require(bool kept, const char* promise) {
  if (kept) return;
  std::fprintf(stderr, "broken promise: %s\n", promise);
  std::abort();
}

// The promises of MeshData. Polygons, which subdivide() judges, keep positions as they are.
inline void require_promises(const MeshData& mesh) {
  const size_t vertices = mesh.positions.size() / 3, triangles = mesh.indices.size() / 3;
  require(mesh.positions.size() == 3 * vertices && mesh.indices.size() == 3 * triangles, "whole rows");
  require(mesh.normals.empty() || mesh.normals.size() == 3 * vertices, "a normal for each vertex");
  require(mesh.uvs.empty() || mesh.uvs.size() == 2 * vertices, "a uv for each vertex");
  require(mesh.colors.empty() || mesh.colors.size() == 4 * vertices, "a colour for each vertex");
  require(mesh.materials.empty() || mesh.materials.size() == triangles, "a material for each triangle");
  for (uint32_t index : mesh.indices) require(index < vertices, "indices in range");
  for (uint32_t material : mesh.materials) require(material < mesh.material_names.size(), "materials in range");
  size_t fans = 0;
  for (uint32_t corners : mesh.polygons) fans += corners - 2;
  require(mesh.polygons.empty() || fans == triangles, "the triangles are the polygons' fans");
  for (float x : mesh.positions) {
    require(!mesh.polygons.empty() || std::fabs(x) <= kMaxCoordinate, "finite positions");
  }
  for (float x : mesh.uvs) require(std::isfinite(x), "finite uvs");
  for (float x : mesh.colors) require(std::isfinite(x), "finite colours");
  for (size_t i = 0; i < mesh.normals.size(); i += 3) {
    const double length = std::hypot(mesh.normals[i], mesh.normals[i + 1], mesh.normals[i + 2]);
    require(std::fabs(length - 1.0) < 1e-6, "unit normals");
  }
  const MeshReport& report = mesh.report;
  require(triangles + report.nonfinite_triangles + report.degenerate_triangles == report.triangles_read,
          "every triangle counted");
}

// Reads the bytes as a file: a mesh that keeps its promises, or a ReadError that says what is allowed.
template <class Read>
int fuzz_reader(Read read, const uint8_t* data, size_t size) {
  try {
    require_promises(read(std::string_view(reinterpret_cast<const char*>(data), size), std::string("fuzz")));
  } catch (const ReadError& error) {
    const std::string_view text = error.what();
    require(text.find(": allowed ") != text.npos, "an error says what is allowed");
    require(text.size() < 2000, "an error is short");
  }
  return 0;
}

}  // namespace accuray::mesh
