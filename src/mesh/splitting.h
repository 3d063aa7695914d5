// Splits triangles until their edges are short in a picture.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace accuray::mesh {

// How long things are in a picture.
struct View {
  enum class Projection {
    perspective,   // scale: pixels per unit of tangent
    orthographic,  // scale: pixels per metre
    angular        // scale: pixels per radian, in all directions
  };
  Projection projection = Projection::perspective;
  std::array<double, 12> to_camera{};  // rows of a 3 x 4 matrix from the mesh to a camera that looks along -z
  double scale = 1.0;
  std::array<double, 4> window{};  // of the picture, at distance 1 or in metres: left, right, bottom, top
};

// How much longer than its bound an edge may be where it is out of view or points at the camera.
inline constexpr double kUnseen = 8.0;

enum class Measure {
  seen,  // the part of an edge that is in view, or 1 / kUnseen of its length if it faced the camera, whichever is more:
         // that keeps triangles of a sensible shape, and coarse where they are not seen
  facing  // as if the edge faced the camera, in view or not
};

// Length in pixels of the edge from each corner of a triangle to the next; the same in both directions of an edge.
std::vector<float> lengths_in_view(std::span<const float> positions, std::span<const uint32_t> indices,
                                   const View& view, Measure measure);

// Marks so that every triangle with a mark has one on its longest edge too: halving these again and again spoils no
// angle (Rivara 1984). Both sides of an edge, and the two edges along a seam, have the same mark afterwards.
std::vector<uint8_t> spread_marks(std::span<const float> positions, std::span<const uint32_t> indices,
                                  std::span<const uint8_t> marks);

// Halves every edge that is marked; marks: one for each corner, of the edge to the next, equal on both sides. Triangles
// without marks stay. Vertices at the same place stay at the same place, so no crack opens. Normals, uvs and colours
// are carried along.
MeshData split_edges(const MeshData& mesh, std::span<const uint8_t> marks);

}  // namespace accuray::mesh
