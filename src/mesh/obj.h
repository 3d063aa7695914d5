// Wavefront OBJ, polygons only.
#pragma once

#include <string>
#include <string_view>

#include "mesh/mesh.h"

namespace accuray::mesh {

// Reads the polygons of a file as one mesh; throws ReadError with the line, the offending text and what was allowed.
//
// v   3, 4 or 6 numbers; w is ignored, a colour is kept as one with the sRGB curve, as MeshLab and Blender write it.
// vt  1 to 3 numbers, of which u and v are kept (v is 0 if absent).
// vn  3 numbers.
// f   at least 3 corners v, v/t, v//n or v/t/n; an index counts from 1, or back from the latest if negative. A positive
//     one may refer to a later line. A polygon is cut into a fan around its first corner, so it should be convex.
// usemtl, mtllib: the material of each triangle by its name, and what the file says of where materials are.
// s   the smoothing group of the faces that follow, 0 or off for none. Groups make the normals of a file that has no
// vn. Ignored: g, o, p, l. Other keywords are counted in the report.
//
// Corners with equal v, t and n share a vertex; vertices come in the order in which faces use them. If some corners
// have a normal and others have none, those others get smooth normals; likewise a missing uv becomes (0, 0), a missing
// colour white. All are counted. A `\` at the end of a line joins it with the next, except in a comment. Numbers may be
// nan, inf or too large: see repair() in checks.h for what happens to their triangles.
//
// keep_polygons: the sizes of the polygons too, and no normals; see repair().
MeshData read_obj(const std::string& path, bool keep_polygons = false);

// The same from memory; `name` stands for the file in messages.
MeshData read_obj_text(std::string_view text, const std::string& name = "<memory>", bool keep_polygons = false);

}  // namespace accuray::mesh
