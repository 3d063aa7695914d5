// The shapes that a scene can name and that are lowered to triangle meshes: lower/solids.h and lower/teapot.h cut them.
// None of them reaches a kernel, so their parameters fill no member.
#pragma once

#include "kernels/dispatch.h"
#include "kernels/geometry/refinement_params.h"
#include "kernels/schema.h"

namespace accuray {

// Conventions
//   - The front side is the outside; vertices lie on the true surface, normals are those of the true surface.
//   - u runs around an axis or along a curve, v across it, both from 0 to 1 and so that dp/du x dp/dv points outside.

constexpr Param segments_param(const char* name, const char* doc, const char* preset) {
  return {.name = name, .kind = Kind::integer, .doc = doc, .preset = preset, .low = 3, .high = 65536};
}
constexpr Param length_param(const char* name, const char* doc, const char* preset) {
  return {
      .name = name, .kind = Kind::real, .doc = doc, .preset = preset, .low = 1e-12, .unit = "m", .animatable = true};
}
constexpr Param center_param(const char* doc) {
  return {.name = "center", .kind = Kind::vec, .doc = doc, .preset = "[0, 0, 0]", .unit = "m", .animatable = true};
}
constexpr Param axis_param() {
  return {.name = "axis",
          .kind = Kind::vec,
          .doc = "Direction of the axis that it lies around; any length but zero.",
          .preset = "[0, 1, 0]",
          .animatable = true};
}
constexpr Param shading_param() {
  return {.name = "shading",
          .kind = Kind::choice,
          .doc = "smooth: with the normals of the true surface; flat: its facets show.",
          .preset = "\"smooth\"",
          .choices = "smooth|flat"};
}

struct Cube {
  static constexpr const char* name = "cube";
  static constexpr const char* doc =
      "A box with its edges along the axes. Each face has the texture coordinates 0 to 1.";
  static constexpr auto own_params() {
    return param_list(center_param("Centre."), Param{.name = "size",
                                                     .kind = Kind::vec,
                                                     .doc = "Lengths of the edges along x, y and z.",
                                                     .preset = "[1, 1, 1]",
                                                     .low = 1e-12,
                                                     .unit = "m",
                                                     .animatable = true});
  }
  static constexpr auto params() { return joined(own_params(), refinement_params()); }
};

struct Cylinder {
  static constexpr const char* name = "cylinder";
  static constexpr const char* doc =
      "A round cylinder between two points. v runs from start to end; a cap has the coordinates of its bounding "
      "square.";
  static constexpr auto own_params() {
    return param_list(
        Param{.name = "start",
              .kind = Kind::vec,
              .doc = "Centre of one end.",
              .preset = "[0, 0, 0]",
              .unit = "m",
              .animatable = true},
        Param{.name = "end",
              .kind = Kind::vec,
              .doc = "Centre of the other end.",
              .preset = "[0, 1, 0]",
              .unit = "m",
              .animatable = true},
        length_param("radius", "Radius.", "0.5"),
        Param{.name = "caps", .kind = Kind::boolean, .doc = "Whether its ends are closed.", .preset = "true"},
        segments_param("segments", "Segments around.", "96"), shading_param());
  }
  static constexpr auto params() { return joined(own_params(), refinement_params()); }
};

struct Torus {
  static constexpr const char* name = "torus";
  static constexpr const char* doc = "A ring. u runs around its axis, v around its tube.";
  static constexpr auto own_params() {
    return param_list(center_param("Centre."), axis_param(),
                      length_param("radius", "Radius of the circle in the middle of the tube.", "1"),
                      length_param("tube_radius", "Radius of the tube; less than `radius`.", "0.25"),
                      segments_param("segments", "Segments around the axis.", "128"),
                      segments_param("tube_segments", "Segments around the tube.", "48"), shading_param());
  }
  static constexpr auto params() { return joined(own_params(), refinement_params()); }
};

struct TorusKnot {
  static constexpr const char* name = "torus_knot";
  static constexpr const char* doc =
      "A closed tube that winds `p` times around an axis and `q` times around a ring. u runs along it, v around it.";
  static constexpr auto own_params() {
    return param_list(
        center_param("Centre of the ring."), axis_param(),
        Param{.name = "p",
              .kind = Kind::integer,
              .doc = "Turns around the axis; has no factor in common with `q`.",
              .preset = "2",
              .low = 1,
              .high = 64},
        Param{.name = "q", .kind = Kind::integer, .doc = "Turns around the ring.", .preset = "3", .low = 1, .high = 64},
        length_param("radius", "Radius of the ring.", "1"),
        length_param("winding_radius", "Distance of the knot from the ring; less than `radius`.", "0.4"),
        length_param("tube_radius", "Radius of the tube; less than that of the tightest bend.", "0.2"),
        segments_param("segments", "Segments along the knot.", "512"),
        segments_param("tube_segments", "Segments around the tube.", "48"), shading_param());
  }
  static constexpr auto params() { return joined(own_params(), refinement_params()); }
};

struct Teapot {
  static constexpr const char* name = "teapot";
  static constexpr const char* doc =
      "The Utah teapot, from the 32 Bezier patches of Newell (1975) and Crow (1987): it stands on the origin with its "
      "spout to +x. It is no closed surface: the lid lies loose, handle and spout pass into the body.";
  static constexpr auto own_params() {
    return param_list(center_param("Centre of its bottom."),
                      length_param("height", "Height from the bottom to the tip of the lid.", "1"),
                      Param{.name = "segments",
                            .kind = Kind::integer,
                            .doc = "Segments along each edge of a patch.",
                            .preset = "16",
                            .low = 2,
                            .high = 65536},
                      shading_param());
  }
  static constexpr auto params() { return joined(own_params(), refinement_params()); }
};

using Solids = TypeList<Cube, Cylinder, Torus, TorusKnot, Teapot>;

}  // namespace accuray
