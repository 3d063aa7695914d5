// Cuts the shapes of kernels/geometry/solids.h into triangles.
#pragma once

#include <span>

#include "lower/parameters.h"
#include "mesh/mesh.h"

namespace accuray {

// The mesh of a shape by its type's name. Vertices and normals are computed in double by correctly rounded operations
// and rounded once to float, so they have the same bits on every machine.
//
// `newell`: the teapot's control points, 32 patches of 4 x 4, +Z up; other types need none.
// Throws std::invalid_argument for parameters that contradict each other, for more than max_triangles, and for sizes
// that are lost in the rounding of the coordinates or exceed them.
mesh::MeshData tessellate(std::string_view type, const Values& values, std::span<const double> newell);

}  // namespace accuray
