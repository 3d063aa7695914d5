// A mesh where it stands, as kernels read it: position, normal and texture coordinates of a vertex side by side.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kernels/geometry/shapes.h"
#include "lower/block.h"
#include "lower/bounds.h"
#include "lower/transform.h"

namespace accuray {

// Bulk arrays of a mesh; empty normals, uvs or colors: none. A mesh that deforms has the positions and normals of its
// keys one after another: `segments` + 1 times as many rows as there are vertices.
struct MeshArrays {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  std::vector<float> normals;
  std::vector<float> uvs;
  std::vector<float> colors;
  uint32_t segments = 0;

  size_t vertex_count() const { return positions.size() / 3 / (segments + 1); }
};

// Arrays in sections that many scenes may show; sections without data: none. The slices of `layout` are nowhere yet.
struct PlacedMesh {
  Mesh layout{};
  Section vertices, indices, colors;
  Bounds bounds;  // at all keys

  std::span<const uint32_t> index_values() const {
    return {reinterpret_cast<const uint32_t*>(indices.data), indices.size / sizeof(uint32_t)};
  }
};

// Throws invalid_argument for more numbers than a mesh can hold.
PlacedMesh place_mesh(MeshArrays arrays, const std::optional<Matrix>& transform);

// Applies a transform; mirroring turns the winding around so that the front side stays the front side.
void move_mesh(const Matrix& m, MeshArrays& mesh);

// Positions of the vertices at the first key, 3 floats each, from the bytes of their section.
std::vector<float> positions_of(const Mesh& mesh, const uint8_t* vertices);

}  // namespace accuray
