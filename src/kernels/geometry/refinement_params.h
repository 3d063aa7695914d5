// What says how finely a shape is cut and how it is displaced: for meshes and all shapes that are lowered to meshes.
// mesh/subdivision.h, mesh/splitting.h and mesh/displacement.h do it; no kernel reads these parameters.
#pragma once

#include "kernels/schema.h"

namespace accuray {

// Conventions
//   - Displacement moves a point by (texture - displacement_offset) * displacement_scale, in the shape's own space,
//     before its transform. Textures are read at texture coordinates and points of that space too.
constexpr auto refinement_params() {
  return param_list(
      Param{
          .name = "subdivision_levels",
          .kind = Kind::integer,
          .doc = "How often every edge is halved. Without this and edge_length_px: 3 for subdivision surfaces, else 0.",
          .low = 0,
          .high = 12,
          .group = "fineness?:levels"},
      Param{.name = "edge_length_px",
            .kind = Kind::real,
            .doc =
                "Edges are halved until none is longer in the camera's picture; up to 8 times as long where they are "
                "out of view or point at the camera.",
            .low = 0.05,
            .high = 1e6,
            .unit = "px",
            .group = "fineness?:pixels"},
      Param{.name = "max_triangles",
            .kind = Kind::integer,
            .doc = "More triangles than this are refused before they are made.",
            .preset = "8000000",
            .low = 1,
            .high = 1e9},
      Param{.name = "displacement",
            .kind = Kind::reference,
            .doc =
                "Texture that moves the surface: its red channel, or red, green and blue, as displacement_space says. "
                "The shape has to be fine enough to show it.",
            .role = "texture",
            .texturable = true},
      Param{.name = "displacement_scale",
            .kind = Kind::real,
            .doc = "Way for a texture value of 1.",
            .preset = "1",
            .unit = "m",
            .animatable = true},
      Param{.name = "displacement_offset",
            .kind = Kind::real,
            .doc = "Texture value that moves nothing (mid-level).",
            .preset = "0",
            .animatable = true},
      Param{.name = "displacement_space",
            .kind = Kind::choice,
            .doc = "normal: red along the normal; object: red, green and blue along x, y and z; tangent: red along the "
                   "direction of u, green across it towards v, blue along the normal.",
            .preset = "\"normal\"",
            .choices = "normal|object|tangent"});
}

// What only meshes have: a smooth surface that they control.
constexpr auto subdivision_params() {
  return param_list(
      Param{.name = "subdivision",
            .kind = Kind::choice,
            .doc = "The smooth surface that the faces control: catmull_clark (any polygons), loop (triangles), none.",
            .preset = "\"none\"",
            .choices = "none|catmull_clark|loop"},
      Param{.name = "creases",
            .kind = Kind::array,
            .doc =
                "Edges that stay sharp: two vertices, and for how many levels, 10 for ever; only with subdivision and "
                "positions.",
            .low = 0,
            .role = "Ex3"},
      Param{.name = "corners",
            .kind = Kind::array,
            .doc =
                "Vertices that stay sharp: the vertex, and for how many levels, 10 for ever; only with subdivision and "
                "positions.",
            .low = 0,
            .role = "Cx2"},
      Param{.name = "uv_subdivision",
            .kind = Kind::choice,
            .doc =
                "smooth: uvs and colours follow the rules of the surface, with seams as open edges; linear: straight "
                "between those of the vertices.",
            .preset = "\"smooth\"",
            .choices = "smooth|linear"});
}

}  // namespace accuray
