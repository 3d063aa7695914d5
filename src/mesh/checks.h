// Repairs that every mesh goes through, whatever format it comes from.
#pragma once

#include <string_view>

#include "mesh/mesh.h"

namespace accuray::mesh {

// Throws ReadError for an index that is not below the number of vertices. `name` stands for the file.
void require_indices_in_range(const MeshData& mesh, std::string_view name);

// Makes the promises of MeshData true, given that all indices are in range, and counts in the report what it took:
// - drops triangles with a coordinate that is NaN, infinite or beyond kMaxCoordinate;
// - drops triangles of no area: the sine of the angle opposite the longest edge is below 2^-50 in double arithmetic,
//   so equal and exactly collinear vertices go, while slivers and tiny triangles of any true area stay;
// - if a vertex is not finite, removes it and all vertices that no triangle uses;
// - scales normals to unit length; replaces those that are zero or not finite by smooth normals (see normals.h);
// - sets uvs that are not finite to (0, 0), and colours that are not finite to opaque white.
// A mesh of polygons is the control mesh of a surface: it keeps all of them, for subdivide() to judge, and no normals.
void repair(MeshData& mesh);

}  // namespace accuray::mesh
