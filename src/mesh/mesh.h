// A triangle mesh as the readers return it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace accuray::mesh {

// Coordinates beyond this are refused like infinities: Embree silently drops triangles above 1.844e18.
inline constexpr float kMaxCoordinate = 1e18f;

// What was left out or made up. Nothing in it is an error; the rest of the mesh renders.
struct MeshReport {
  uint64_t triangles_read = 0;        // after cutting polygons into triangles
  uint64_t nonfinite_triangles = 0;   // dropped: a coordinate is NaN, infinite or beyond kMaxCoordinate
  uint64_t degenerate_triangles = 0;  // dropped: equal or collinear vertices
  uint64_t nonfinite_vertices = 0;    // removed with those triangles
  uint64_t generated_normals = 0;     // vertices whose normal was missing, zero or not finite
  uint64_t missing_uvs = 0;           // vertices whose uv was missing or not finite: set to (0, 0)
  uint64_t missing_colors = 0;        // vertices whose colour was missing or not finite: set to white
  uint64_t unknown = 0;               // OBJ: lines with an unknown keyword; PLY: properties that are not used
  std::string first_unknown;          // the first of these, as text with its place
};

// Arrays of N vertices and M triangles. Every index is below N, every value finite, every normal of unit length.
struct MeshData {
  std::vector<float> positions;            // 3 N
  std::vector<float> normals;              // 3 N, or empty: the file has none
  std::vector<float> uvs;                  // 2 N, or empty: the file has none
  std::vector<float> colors;               // 4 N: red, green, blue and alpha from 0 to 1; or empty: the file has none
  bool srgb_colors = false;                // the colours, but not alpha, are stored with the sRGB curve
  std::vector<uint32_t> indices;           // 3 M; the front side of a triangle is the counter-clockwise one
  std::vector<uint32_t> polygons;          // corners of each polygon, whose fans the indices are; or empty: no polygons
  std::vector<uint32_t> materials;         // M: index into material_names; or empty: the file names none
  std::vector<uint32_t> smoothing_groups;  // M: 0 is flat; or empty: the file has none
  std::vector<std::string> material_names;  // in the order of their first use
  std::vector<std::string> libraries;       // what the file names its materials' files, one text per line
  MeshReport report;
};

}  // namespace accuray::mesh
