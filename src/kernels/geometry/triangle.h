// The triangles of a mesh, as they are at a moment.
//
// A vertex holds its position, normal and texture coordinates side by side, so that a hit of a large mesh waits for
// three cache lines, not for nine. The vertices of a mesh that deforms follow for every key; between two keys its
// positions and normals move on straight lines, as Embree moves them.
#pragma once

#include "kernels/geometry/motion.h"
#include "kernels/geometry/shapes.h"

namespace accuray {

inline Vec3 load_vec3(const float* values, uint32_t index) {
  const float* v = values + size_t{3} * index;
  return {v[0], v[1], v[2]};
}

struct Triangle {
  Vec3 p0, p1, p2;
  const float *v0, *v1, *v2;  // the vertices, at the key before
};

// Floats from the first key to the one before a moment and from there to the next, and how far along it is.
struct KeyPair {
  uint64_t before, next;
  float share;
};
inline KeyPair key_pair(const Mesh& mesh, float time) {
  if (mesh.segments == 0) return {0, 0, 0.0f};
  const Step step = step_at(time, mesh.segments);
  return {mesh.floats_per_key() * step.segment, mesh.floats_per_key(), step.share};
}

// Three numbers of a vertex. Still meshes go the same way, with a share of 0: a branch for each vertex, and calls for
// those that deform, cost a GPU's thread a tenth of its stack.
inline Vec3 at_moment(const float* values, const KeyPair& keys) {
  return fma(1.0f - keys.share, load_vec3(values, 0), load_vec3(values + keys.next, 0) * keys.share);
}

inline Triangle triangle_of(const SceneView& scene, const Mesh& mesh, uint32_t primitive, float time) {
  const KeyPair keys = key_pair(mesh, time);
  const uint32_t* index = scene.at(mesh.indices) + size_t{3} * primitive;
  const float* vertices = scene.at(mesh.vertices) + keys.before;
  const float* v0 = vertices + size_t{mesh.stride} * index[0];
  const float* v1 = vertices + size_t{mesh.stride} * index[1];
  const float* v2 = vertices + size_t{mesh.stride} * index[2];
  return {at_moment(v0, keys), at_moment(v1, keys), at_moment(v2, keys), v0, v1, v2};
}

// Interpolated normal at barycentric coordinates of vertices 1 and 2, of any length; only for meshes that have normals.
inline Vec3 vertex_normal(const Mesh& mesh, const Triangle& tri, float u, float v, float time) {
  const KeyPair keys = key_pair(mesh, time);
  const Vec3 n0 = at_moment(tri.v0 + mesh.normal, keys);
  const Vec3 n1 = at_moment(tri.v1 + mesh.normal, keys);
  const Vec3 n2 = at_moment(tri.v2 + mesh.normal, keys);
  return fma(1.0f - u - v, n0, fma(u, n1, n2 * v));
}

}  // namespace accuray
