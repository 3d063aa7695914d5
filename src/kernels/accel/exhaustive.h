// The intersector without an acceleration structure: every ray meets every primitive. It judges the others in tests and
// runs wherever the kernels do.
#pragma once

#include "kernels/accel/accel.h"
#include "kernels/geometry/intersect.h"
#include "kernels/geometry/surface.h"

namespace accuray {

struct Exhaustive {
  const SceneView* scene;

  // Never inlined: its loops would be repeated at every call and make the kernel slow to compile.
  ACCURAY_NOINLINE Hit closest(const Ray& ray) const {
    Hit hit;
    hit.t = ray.far;
    // First the scene itself, then its instances: one loop, so that a GPU's thread keeps one copy of what is in it.
    uint32_t first = 0;
    uint32_t count = scene->root->top_geometries;
    Ray local = ray;
    for (uint32_t next = 0;; ++next) {
      meet(local, first, count, next - 1, hit);
      if (next == scene->root->instances.count) break;
      const InstanceRecord& instance = scene->instances[next];
      first = instance.first;
      count = instance.count;
      local = carried(instance, ray);
    }
    return hit;
  }
  float transmittance(const Ray& ray) const { return closest(ray).geometry == none ? 1.0f : 0.0f; }

 private:
  Ray carried(const InstanceRecord& instance, Ray ray) const {
    if (instance.motion != none) return into_moving(*scene, instance.motion, ray);
    ray.origin = instance.to_world.point_back(ray.origin);
    ray.direction = instance.to_world.vector_back(ray.direction);
    return ray;
  }
  void meet(const Ray& ray, uint32_t first, uint32_t count, uint32_t instance, Hit& hit) const {
    ACCURAY_NO_UNROLL
    for (uint32_t g = first; g < first + count; ++g) {
      const GeometryRecord& geometry = scene->geometries[g];
      if (geometry.shape.tag == tag_of<Mesh>(Shapes{})) {
        meet_mesh(ray, scene->as<Mesh>(geometry.shape), g, instance, hit);
        continue;
      }
      const float t = geometry.shape.tag == tag_of<Sphere>(Shapes{})
                          ? intersect(scene->as<Sphere>(geometry.shape), ray, hit.t)
                          : intersect(scene->as<Disk>(geometry.shape), ray, hit.t);
      if (t > 0.0f) hit = {t, 0.0f, 0.0f, 0, g, instance};
    }
  }
  void meet_mesh(const Ray& ray, const Mesh& mesh, uint32_t geometry, uint32_t instance, Hit& hit) const {
    ACCURAY_NO_UNROLL
    for (uint32_t p = 0; p < mesh.indices.count / 3; ++p) {
      const Triangle tri = triangle_of(*scene, mesh, p, ray.time);
      TriangleHit found;
      if (intersect_triangle(tri.p0, tri.p1, tri.p2, ray, hit.t, found)) {
        hit = {found.t, found.u, found.v, p, geometry, instance};
      }
    }
  }
};

}  // namespace accuray
