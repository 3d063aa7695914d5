// Subdivision surfaces: Catmull-Clark over polygons, Loop over triangles.
#pragma once

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "mesh/mesh.h"
#include "mesh/refinement.h"

namespace accuray::mesh {

// A number that does not fit the mesh, and which list it stands in: "creases" or "corners".
class BadCrease : public std::invalid_argument {
 public:
  BadCrease(const char* list, const std::string& problem) : std::invalid_argument(problem), list_(list) {}
  const char* list() const { return list_; }

 private:
  const char* list_;
};

struct Crease {
  uint32_t a, b;
  float sharpness;
};
struct Peak {
  uint32_t vertex;
  float sharpness;
};

struct Subdivision {
  Scheme scheme = Scheme::catmull_clark;
  uint32_t levels = 1;                         // 1 or more
  Smoothness attributes = Smoothness::smooth;  // of uvs and colours
  std::vector<Crease> creases;                 // by the numbers of vertices
  std::vector<Peak> corners;
  double least_cosine = -2.0;  // edges between polygons whose normals have a smaller one are sharp for ever
};

// Triangles that subdivide() will make of a mesh of so many triangles and polygons.
uint64_t subdivided_triangles(uint64_t triangles, uint64_t polygons, Scheme scheme, uint32_t levels);

// The surface that the mesh controls: vertices of the refined mesh moved to where they end after infinitely many steps,
// with the normals of that surface, and triangles. Fewer levels are fewer of the same points.
//
// - Vertices at exactly the same position are one. Catmull-Clark takes control.polygons if there are any; else both
//   schemes take triangles. Normals of the control mesh are not used.
// - Open edges are sharp: cubic B-splines that end at vertices of one polygon only. So are edges of more than two
//   polygons, or of two that disagree about the front side. Where a closed fan meets others in one vertex, that stays.
// - Uvs and colours are smooth like the positions, with the same creases and, at seams, the rules for open edges; or
//   linear between those of the control mesh.
// - Polygons with a vertex twice, or with a coordinate that repair() would drop, are left out and counted.
// Throws BadCrease for a crease that is no edge, and for numbers of vertices that do not exist.
MeshData subdivide(const MeshData& control, const Subdivision& how);

}  // namespace accuray::mesh
