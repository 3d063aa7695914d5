// Smooth vertex normals for meshes that have none.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace accuray::mesh {

// One unit normal per vertex: the mean of the normals of the triangles around it, weighted by their angles there
// (Thuermer and Wuethrich 1998), so that cutting a face into more triangles changes nothing.
//
// Vertices at exactly the same position count as one, so a seam of the uvs stays smooth. Where the normals around a
// position cancel (the two sides of a leaf), each vertex uses its own triangles alone; where these cancel too, one of
// them. A vertex without triangles gets (0, 1, 0).
//
// positions: 3 N finite values; indices: 3 M values below N, no triangle without area. Returns 3 N values.
// Only + - * / and sqrt are used, so the result has the same bits on every machine.
std::vector<float> smooth_normals(std::span<const float> positions, std::span<const uint32_t> indices);

// A mesh whose vertices are split where its surface has edges: vertex i is a copy of vertex source[i].
struct CreasedMesh {
  std::vector<uint32_t> source;
  std::vector<uint32_t> indices;  // 3 M
  std::vector<float> normals;     // 3 per vertex, unit
};

// Normals that are smooth except across edges. Two triangles are smooth across the edge between them if their normals
// have a cosine of at least `least_cosine` and, where `groups` is not empty (one number per triangle), if they are of
// the same group other than 0. The normal of a vertex is the mean over those triangles that reach each other around it
// across smooth edges, weighted as by smooth_normals(); where these cancel, that of the triangle itself.
//
// positions and indices as for smooth_normals(). Positions, not vertices, tell which triangles are neighbours. Where
// more than two triangles share an edge, each is compared with the next.
CreasedMesh creased_normals(std::span<const float> positions, std::span<const uint32_t> indices,
                            std::span<const uint32_t> groups, double least_cosine);

}  // namespace accuray::mesh
