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
    meet(ray, 0, scene->root->top_geometries, none, hit);
    for (uint32_t i = 0; i < scene->root->instances.count; ++i) {
      const InstanceRecord& instance = scene->instances[i];
      if (instance.motion != none) {
        meet(into_moving(*scene, instance.motion, ray), instance.first, instance.count, i, hit);
        continue;
      }
      Ray local = ray;
      local.origin = instance.to_world.point_back(ray.origin);
      local.direction = instance.to_world.vector_back(ray.direction);
      meet(local, instance.first, instance.count, i, hit);
    }
    return hit;
  }
  float transmittance(const Ray& ray) const { return closest(ray).geometry == none ? 1.0f : 0.0f; }

 private:
  void meet(const Ray& ray, uint32_t first, uint32_t count, uint32_t instance, Hit& hit) const {
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
    for (uint32_t p = 0; p < mesh.indices.count / 3; ++p) {
      const Triangle tri = triangle_of<true>(*scene, mesh, p, ray.time);
      TriangleHit found;
      if (intersect_triangle(tri.p0, tri.p1, tri.p2, ray, hit.t, found)) {
        hit = {found.t, found.u, found.v, p, geometry, instance};
      }
    }
  }
};

}  // namespace accuray
