// STL, the format of stereolithography: ASCII and binary.
#pragma once

#include <string>
#include <string_view>

#include "mesh/mesh.h"

namespace accuray::mesh {

// Reads the triangles of a file as one mesh; throws ReadError with the line (ASCII) or the byte (binary), the offending
// text and what was allowed.
//
// A file whose size is that of the number of triangles it declares is binary, whatever it begins with; else one that
// begins with `solid` is ASCII. The number is checked against the size before anything is allocated. Bytes after the
// last triangle are an error: the mesh would silently be a part of itself.
//
// Vertices at exactly the same position become one, in the order of their first use. The normals of facets are not
// kept, for they follow from the vertices, and neither are the two bytes after each binary triangle. The solids of one
// ASCII file become one mesh.
MeshData read_stl(const std::string& path);

// The same from memory; `name` stands for the file in messages.
MeshData read_stl_bytes(std::string_view bytes, const std::string& name = "<memory>");

}  // namespace accuray::mesh
