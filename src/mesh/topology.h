// Polygons over vertices as subdivision sees them: edges, neighbours and sharpness.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace accuray::mesh {

// Sharpness from which an edge or vertex is sharp for ever; open edges have it too.
inline constexpr float kSharp = 10.0f;

// The polygons of one level. A corner is the place of a vertex in a polygon; the edge of a corner leads to the next
// one.
struct Faces {
  uint32_t count = 0;
  uint32_t sides = 0;             // of every polygon; 0: they differ, and the next two say how
  std::vector<uint32_t> first;    // count + 1: the first corner of each polygon
  std::vector<uint32_t> face_of;  // of each corner
  std::vector<float> sharpness;   // of the edge of each corner

  static Faces of_sizes(std::span<const uint32_t> sizes);

  uint32_t corners() const { return static_cast<uint32_t>(sharpness.size()); }
  uint32_t face(uint32_t c) const { return sides != 0 ? c / sides : face_of[c]; }
  uint32_t begin(uint32_t f) const { return sides != 0 ? f * sides : first[f]; }
  uint32_t end(uint32_t f) const { return begin(f + 1); }
  uint32_t next(uint32_t c) const { return c + 1 == end(face(c)) ? begin(face(c)) : c + 1; }
  uint32_t previous(uint32_t c) const { return c == begin(face(c)) ? end(face(c)) - 1 : c - 1; }
};

// Values at vertices, which the corners of some polygons share. Positions and texture coordinates are two nets over the
// same polygons: where the coordinates have a seam, theirs has open edges.
struct Net {
  size_t width = 0;              // numbers per vertex
  std::vector<double> points;    // width per vertex
  std::vector<uint32_t> vertex;  // of each corner
  std::vector<float> peak;       // sharpness of each vertex

  uint32_t vertices() const { return static_cast<uint32_t>(peak.size()); }
  const double* at(uint32_t v) const { return points.data() + width * v; }
};

// The edges of a net. Two polygons are neighbours if no third one shares their edge and they run along it in opposite
// directions; all other edges are open.
struct Edges {
  std::vector<uint32_t> of_corner;
  std::vector<uint32_t> corner;  // one corner of each edge
  std::vector<uint32_t> twin;    // of each corner: that of the neighbour, kNone at an open edge

  Edges(const Net& net, const Faces& faces);

  uint32_t count() const { return static_cast<uint32_t>(corner.size()); }
  float sharpness(const Faces& faces, uint32_t c) const;
};

// The next corner around the same vertex, counter-clockwise; kNone beyond an open edge.
inline uint32_t turned_left(const Faces& faces, const Edges& edges, uint32_t c) {
  return edges.twin[faces.previous(c)];
}

// Vertices whose polygons form more than one fan, one of them closed: sharp for ever, for no curve leads through them.
void pin_pinched_vertices(Net& net, const Faces& faces, const Edges& edges);

// Vertices of one polygon only, between two open edges.
void pin_lone_corners(Net& net, const Faces& faces, const Edges& edges);

}  // namespace accuray::mesh
