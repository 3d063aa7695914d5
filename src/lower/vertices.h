// The vertices of a mesh as kernels read them: position, normal and texture coordinates side by side.
#pragma once

#include <vector>

#include "kernels/geometry/shapes.h"
#include "lower/block.h"

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

// Fills the layout of `mesh`, all but its slices, and returns the section for its vertices. Sections begin at cache
// lines, so that no vertex of 32 bytes lies in two.
Section interleave(const MeshArrays& arrays, Mesh& mesh);

// Positions of the vertices at the first key, 3 floats each.
std::vector<float> positions_of(const Mesh& mesh, const float* vertices);

}  // namespace accuray
