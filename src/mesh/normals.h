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

}  // namespace accuray::mesh
