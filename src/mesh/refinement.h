// One step of subdivision, and what the surface is after infinitely many.
#pragma once

#include "mesh/topology.h"

namespace accuray::mesh {

enum class Scheme {
  catmull_clark,  // Catmull and Clark 1978
  loop            // Loop 1987
};

// How a net is refined: by the rules of the scheme, or by halving alone.
enum class Smoothness { smooth, linear };

// Semi-sharp edges and vertices are as of DeRose, Kass and Truong 1998: sharp for as many steps as their sharpness
// says, and for its fraction in between. Where two such edges meet, a vertex is on a crease; where three do, a corner.
Net refined(const Net& net, const Faces& faces, const Edges& edges, Scheme scheme, Smoothness smoothness);

// The polygons of the refined nets: for catmull_clark the quadrilaterals around each polygon's middle from its first
// corner on; for loop the triangles at the corners, and then the middle one.
Faces refined(const Faces& faces, Scheme scheme);

// Where the vertices of a net end after infinitely many steps; for catmull_clark all polygons are quadrilaterals. What
// is still sharp counts as sharp for ever.
std::vector<double> limit_points(const Net& net, const Faces& faces, const Edges& edges, Scheme scheme);

// Normals where the surface has one tangent plane at a vertex, or one on each side of a crease.
struct LimitNormals {
  std::vector<uint32_t> of_corner;
  std::vector<double> normals;  // 3 each, unit
};

// limits: what limit_points() says of the net.
LimitNormals limit_normals(const Net& net, const Faces& faces, const Edges& edges, Scheme scheme,
                           const std::vector<double>& limits);

}  // namespace accuray::mesh
