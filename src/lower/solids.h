// Cuts the shapes of kernels/geometry/solids.h, and rectangles, into triangles.
#pragma once

#include <span>

#include "lower/parameters.h"
#include "mesh/mesh.h"

namespace accuray {

// A rectangle as the two triangles that it is rendered by. Throws std::invalid_argument if it has no area.
mesh::MeshData rectangle_mesh(const Values& values);

// The mesh of a solid or of a rectangle by its type's name. Vertices and normals are computed in double by correctly
// rounded operations and rounded once to float, so they have the same bits on every machine.
//
// `newell`: the teapot's control points, 32 patches of 4 x 4, +Z up; other types need none.
// Throws std::invalid_argument for parameters that contradict each other, for more than max_triangles, and for sizes
// that are lost in the rounding of the coordinates or exceed them.
mesh::MeshData tessellate(std::string_view type, const Values& values, std::span<const double> newell);

}  // namespace accuray
