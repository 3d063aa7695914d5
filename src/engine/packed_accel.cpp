#include "engine/packed_accel.h"

#include "kernels/geometry/surface.h"

namespace accuray {

namespace {

bool is_mesh(const GeometryRecord& geometry) { return geometry.shape.tag == tag_of<Mesh>(Shapes{}); }

void put(float (&target)[3][8], uint32_t lane, Vec3 v) {
  target[0][lane] = v.x;
  target[1][lane] = v.y;
  target[2][lane] = v.z;
}

}  // namespace

bool PackedScene::suits(const SceneView& view) {
  if (view.root->instances.count != 0) return false;
  uint64_t triangles = 0;
  uint32_t analytic = 0;
  for (uint32_t g = 0; g < view.root->top_geometries; ++g) {
    const GeometryRecord& geometry = view.geometries[g];
    if (is_mesh(geometry)) {
      const Mesh& mesh = view.as<Mesh>(geometry.shape);
      if (mesh.segments != 0) return false;
      triangles += mesh.indices.count / 3;
    } else {
      ++analytic;
    }
  }
  return triangles <= most_triangles && analytic <= most_analytic;
}

PackedScene::PackedScene(const SceneView& view) : view_(view) {
  uint32_t lane = 8;
  for (uint32_t g = 0; g < view.root->top_geometries; ++g) {
    const GeometryRecord& geometry = view.geometries[g];
    if (!is_mesh(geometry)) {
      analytic_.push_back(g);
      continue;
    }
    const Mesh& mesh = view.as<Mesh>(geometry.shape);
    for (uint32_t p = 0; p < mesh.indices.count / 3; ++p) {
      if (lane == 8) {
        groups_.push_back({});
        lane = 0;
      }
      const Triangle tri = triangle_of(view, mesh, p, 0.0f);
      Group& group = groups_.back();
      put(group.p0, lane, tri.p0);
      put(group.p1, lane, tri.p1);
      put(group.p2, lane, tri.p2);
      put(group.ac, lane, tri.p0 - tri.p2);
      put(group.ba, lane, tri.p1 - tri.p0);
      put(group.cb, lane, tri.p2 - tri.p1);
      put(group.normal, lane, accuray::cross(tri.p1 - tri.p0, tri.p2 - tri.p0));
      group.geometry[lane] = g;
      group.primitive[lane] = p;
      ++lane;
    }
  }
}

Hit PackedScene::nearest_lane(__m256 t, __m256 u, __m256 v, __m256i group, float far) const {
  alignas(32) float ts[8];
  alignas(32) int32_t groups[8];
  _mm256_store_ps(ts, t);
  _mm256_store_si256(reinterpret_cast<__m256i*>(groups), group);
  uint32_t lane = 8;
  for (uint32_t i = 0; i < 8; ++i) {
    if (groups[i] >= 0 && (lane == 8 || ts[i] < ts[lane])) lane = i;
  }
  Hit hit;
  hit.t = far;
  if (lane == 8) return hit;
  alignas(32) float us[8];
  alignas(32) float vs[8];
  _mm256_store_ps(us, u);
  _mm256_store_ps(vs, v);
  const Group& met = groups_[static_cast<size_t>(groups[lane])];
  return {ts[lane], us[lane], vs[lane], met.primitive[lane], met.geometry[lane], none};
}

float PackedScene::meet_analytic(uint32_t geometry, const Ray& ray, float far) const {
  const Tagged shape = view_.geometries[geometry].shape;
  return shape.tag == tag_of<Sphere>(Shapes{}) ? intersect(view_.as<Sphere>(shape), ray, far)
                                               : intersect(view_.as<Disk>(shape), ray, far);
}

}  // namespace accuray
