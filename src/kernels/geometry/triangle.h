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
  const float *v0, *v1, *v2;  // the vertices, at the first key
};

// Whether a mesh may deform is known where the code for it is worth its place: `Deforms` says it.
template <bool Deforms>
inline Vec3 at_moment(const Mesh& mesh, const float* values, float time) {
  if constexpr (Deforms) {
    if (mesh.segments != 0) {
      const Step step = step_at(time, mesh.segments);
      const float* before = values + mesh.floats_per_key() * step.segment;
      return fma(1.0f - step.share, load_vec3(before, 0), load_vec3(before + mesh.floats_per_key(), 0) * step.share);
    }
  }
  return load_vec3(values, 0);
}

template <bool Deforms>
inline Triangle triangle_of(const SceneView& scene, const Mesh& mesh, uint32_t primitive, float time) {
  const uint32_t* index = scene.at(mesh.indices) + size_t{3} * primitive;
  const float* vertices = scene.at(mesh.vertices);
  const float* v0 = vertices + size_t{mesh.stride} * index[0];
  const float* v1 = vertices + size_t{mesh.stride} * index[1];
  const float* v2 = vertices + size_t{mesh.stride} * index[2];
  return {at_moment<Deforms>(mesh, v0, time),
          at_moment<Deforms>(mesh, v1, time),
          at_moment<Deforms>(mesh, v2, time),
          v0,
          v1,
          v2};
}

// Interpolated normal at barycentric coordinates of vertices 1 and 2, of any length; only for meshes that have normals.
template <bool Deforms>
inline Vec3 vertex_normal(const Mesh& mesh, const Triangle& tri, float u, float v, float time) {
  const Vec3 n0 = at_moment<Deforms>(mesh, tri.v0 + mesh.normal, time);
  const Vec3 n1 = at_moment<Deforms>(mesh, tri.v1 + mesh.normal, time);
  const Vec3 n2 = at_moment<Deforms>(mesh, tri.v2 + mesh.normal, time);
  return fma(1.0f - u - v, n0, fma(u, n1, n2 * v));
}

}  // namespace accuray
