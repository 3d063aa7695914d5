// PLY, the Stanford polygon format: ascii, binary little endian and binary big endian.
#pragma once

#include <string>
#include <string_view>

#include "mesh/mesh.h"

namespace accuray::mesh {

// Reads the elements "vertex" and "face" of a file as one mesh; throws ReadError with the line (header, ascii) or the
// byte (binary), the offending value and what was allowed.
//
// vertex  x y z; nx ny nz; and one pair of u v, s t, texture_u texture_v, texture_s texture_t; of any scalar type.
//         red green blue, and alpha: uchar and ushort are stored with the sRGB curve, float and double are linear.
// face    a list vertex_indices or vertex_index of 3 or more integers below the number of vertices. A polygon is cut
//         into a fan around its first corner, so it should be convex.
//
// Other elements and properties are skipped; the report counts the properties. Counts and list lengths are
// checked against the bytes that are there before anything is allocated for them. More data than the header declares
// are an error too: the mesh would silently be a part of itself. Vertices keep their order unless repair() in
// checks.h has to remove some.
//
// keep_polygons: the sizes of the polygons too, and no normals; see repair().
MeshData read_ply(const std::string& path, bool keep_polygons = false);

// The same from memory; `name` stands for the file in messages.
MeshData read_ply_bytes(std::string_view bytes, const std::string& name = "<memory>", bool keep_polygons = false);

}  // namespace accuray::mesh
