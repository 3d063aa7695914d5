// Moves the vertices of a mesh by what a texture says there.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace accuray::mesh {

// What the three numbers of an offset stand for.
enum class DisplacementSpace {
  normal,  // the first one counts, along the normal
  object,  // along the axes of the mesh
  tangent  // along the direction of u, across it to the side of v, and along the normal
};

// The positions of the vertices, moved by `offsets` (3 per vertex). Vertices at the same place move together, by the
// mean of their ways, so no crack opens at a seam or at a hard edge. Without normals those of smooth_normals() lead the
// way. DisplacementSpace::tangent needs uvs; a vertex where they have no direction takes any tangent.
std::vector<float> displaced(const MeshData& mesh, std::span<const float> offsets, DisplacementSpace space);

}  // namespace accuray::mesh
