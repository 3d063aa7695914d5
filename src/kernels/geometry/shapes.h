// The shapes that a scene can name. Mesh, Sphere and Disk exist in the lowered scene; a rectangle is lowered to a mesh
// of two triangles, those of solids.h to meshes too, and an instance to an InstanceRecord.
#pragma once

#include "kernels/dispatch.h"
#include "kernels/geometry/refinement_params.h"
#include "kernels/geometry/solids.h"
#include "kernels/scene_view.h"
#include "kernels/schema.h"

namespace accuray {

struct Mesh {
  Slice<float> vertices;    // of each its position, normal and texture coordinates, as far as there are; see triangle.h
  Slice<uint32_t> indices;  // 3 per triangle
  Slice<float> colors;      // 4 per vertex, linear Rec.709 and alpha, or empty
  uint32_t vertex_count;
  uint32_t stride;    // floats per vertex
  uint32_t normal;    // first float of a vertex's normal; 0: flat shading
  uint32_t uv;        // first of its texture coordinates; 0: none
  uint32_t segments;  // between the keys of a mesh that deforms, equally long; 0: it does not

  uint64_t floats_per_key() const { return uint64_t{vertex_count} * stride; }

  static constexpr const char* name = "mesh";
  static constexpr const char* doc =
      "Triangles, from an OBJ, PLY or STL file or from arrays, or the smooth surface that they control. The front side "
      "is where the vertices run counter-clockwise.";
  static constexpr auto own_params() {
    return param_list(
        Param{.name = "file",
              .kind = Kind::file,
              .doc = "OBJ, PLY or STL file.",
              .choices = ".obj|.ply|.stl",
              .group = "geometry:file",
              .animatable = true},
        Param{.name = "positions",
              .kind = Kind::array,
              .doc = "Vertex positions.",
              .unit = "m",
              .role = "Nx3",
              .group = "geometry:arrays",
              .animatable = true},
        Param{
            .name = "faces",
            .kind = Kind::array,
            .doc = "Vertex indices of polygons with three or more corners; a polygon is split as a fan from its first.",
            .low = 0,
            .role = "faces",
            .group = "geometry:arrays"},
        Param{.name = "normals",
              .kind = Kind::array,
              .doc = "Vertex normals; only with positions.",
              .role = "Nx3",
              .animatable = true},
        Param{.name = "uvs", .kind = Kind::array, .doc = "Texture coordinates; only with positions.", .role = "Nx2"},
        Param{
            .name = "colors",
            .kind = Kind::array,
            .doc = "Vertex colours, linear Rec.709, and alpha; only with positions. A texture vertex_color reads them.",
            .low = 0,
            .role = "Nx3 or Nx4"},
        Param{
            .name = "shading",
            .kind = Kind::choice,
            .doc = "auto: smooth where there are normals; smooth: normals are made where missing; flat: none are used.",
            .preset = "\"auto\"",
            .choices = "auto|flat|smooth"},
        Param{.name = "crease_angle",
              .kind = Kind::real,
              .doc =
                  "Where there are no normals, they are made, but not across edges that bend by more than this. With "
                  "subdivision such edges are sharp for ever.",
              .low = 0,
              .high = 180,
              .unit = "deg"});
  }
  static constexpr auto params() { return joined(own_params(), joined(subdivision_params(), refinement_params())); }
};

struct Sphere {
  Vec3 center;
  float radius;

  static constexpr bool rigid = true;  // stays one under rotations, translations and one scale only
  static constexpr const char* name = "sphere";
  static constexpr const char* doc = "A perfect sphere; its front side is the outside.";
  static constexpr auto params() {
    return param_list(Param{.name = "center",
                            .kind = Kind::vec,
                            .doc = "Centre.",
                            .preset = "[0, 0, 0]",
                            .unit = "m",
                            .animatable = true,
                            .member = ACCURAY_OFFSET_OF(Sphere, center)},
                      Param{.name = "radius",
                            .kind = Kind::real,
                            .doc = "Radius.",
                            .preset = "1",
                            .low = 1e-12,
                            .unit = "m",
                            .animatable = true,
                            .member = ACCURAY_OFFSET_OF(Sphere, radius)});
  }
};

struct Disk {
  Vec3 center;
  Vec3 normal;  // unit
  float radius;

  static constexpr bool rigid = true;
  static constexpr const char* name = "disk";
  static constexpr const char* doc = "A flat disk; its front side is where the normal points.";
  static constexpr auto params() {
    return param_list(Param{.name = "center",
                            .kind = Kind::vec,
                            .doc = "Centre.",
                            .preset = "[0, 0, 0]",
                            .unit = "m",
                            .animatable = true,
                            .member = ACCURAY_OFFSET_OF(Disk, center)},
                      Param{.name = "normal",
                            .kind = Kind::vec,
                            .doc = "Direction of the front side; any length but zero.",
                            .preset = "[0, 1, 0]",
                            .animatable = true,
                            .member = ACCURAY_OFFSET_OF(Disk, normal)},
                      Param{.name = "radius",
                            .kind = Kind::real,
                            .doc = "Radius.",
                            .preset = "1",
                            .low = 1e-12,
                            .unit = "m",
                            .animatable = true,
                            .member = ACCURAY_OFFSET_OF(Disk, radius)});
  }
};

struct Rectangle {
  Vec3 corner;
  Vec3 edge_u;
  Vec3 edge_v;

  static constexpr const char* name = "rectangle";
  static constexpr const char* doc =
      "A parallelogram, given by a corner and two edges; its front side is that of edge_u x edge_v.";
  static constexpr auto own_params() {
    return param_list(Param{.name = "corner",
                            .kind = Kind::vec,
                            .doc = "One corner.",
                            .preset = "[0, 0, 0]",
                            .unit = "m",
                            .animatable = true,
                            .member = ACCURAY_OFFSET_OF(Rectangle, corner)},
                      Param{.name = "edge_u",
                            .kind = Kind::vec,
                            .doc = "First edge.",
                            .preset = "[1, 0, 0]",
                            .unit = "m",
                            .animatable = true,
                            .member = ACCURAY_OFFSET_OF(Rectangle, edge_u)},
                      Param{.name = "edge_v",
                            .kind = Kind::vec,
                            .doc = "Second edge.",
                            .preset = "[0, 1, 0]",
                            .unit = "m",
                            .animatable = true,
                            .member = ACCURAY_OFFSET_OF(Rectangle, edge_v)});
  }
  static constexpr auto params() { return joined(own_params(), refinement_params()); }
};

struct Instance {
  static constexpr bool rigid = true;
  static constexpr const char* name = "instance";
  static constexpr const char* doc =
      "A copy of prototype shapes under the instance's transform, or as many copies as `instances` has rows.";
  static constexpr auto params() {
    return param_list(
        Param{.name = "of",
              .kind = Kind::reference,
              .doc = "Name or list of names of prototype shapes, which may be instances of others themselves.",
              .role = "shape",
              .required = true},
        Param{.name = "instances",
              .kind = Kind::array,
              .doc =
                  "Transforms, each of a copy: three rows of four numbers, translations in the file's length_unit; "
                  "an array of shape N x 3 x 4 or N x 12 in a .npy file or from Python, or a CSV file with a line of "
                  "twelve numbers for each. Turns, mirrors, moves and one scale; `transform` follows.",
              .unit = "m",
              .choices = ".npy|.csv",
              .role = "file or Nx3x4"},
        Param{.name = "ids",
              .kind = Kind::array,
              .doc = "Which one of `of` each row of `instances` shows, counted from 0; by default it shows all of "
                     "them. A file or array of N whole numbers, or the 13th column of a CSV file of `instances`.",
              .low = 0,
              .choices = ".npy|.csv",
              .role = "file or N"});
  }
};

// What every shape has besides.
struct ShapeCommon {
  static constexpr auto params() {
    return param_list(
        Param{.name = "material",
              .kind = Kind::reference,
              .doc = "Name of the material. Required, but for an instance, whose prototypes have theirs.",
              .role = "material"},
        Param{.name = "transform",
              .kind = Kind::transform,
              .doc = "Object to world. Spheres, disks and instances take one scale only, and no shears.",
              .animatable = true},
        Param{
            .name = "prototype", .kind = Kind::boolean, .doc = "Rendered through instances only.", .preset = "false"});
  }
};

using Shapes = TypeList<Mesh, Sphere, Disk, Rectangle, Cube, Cylinder, Torus, TorusKnot, Teapot, Instance>;

}  // namespace accuray
