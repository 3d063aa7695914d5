// From a hit to a point on a surface: position with its error bound, and normals.
#pragma once

#include "kernels/geometry/motion.h"
#include "kernels/geometry/triangle.h"
#include "kernels/math/rounding.h"

namespace accuray {

// Conventions
//   - `normal` is the geometric normal of the front side, `shading` the interpolated one on the same side of the
//     surface; both unit, in world space.
//   - `error` bounds the distance per axis between `point` and the true surface, and also the rounding of the
//     intersector's plane test, so that offset_origin() by it never meets the same surface again.
struct Surface {
  Vec3 point;
  Vec3 error;
  Vec3 normal;
  Vec3 shading;
  uint32_t material;
  uint32_t light;  // the light that this point belongs to; none: not emissive
};

// Points are interpolated from p0 along the edges, which rounds three times at the magnitude of the coordinates and
// some times at that of the triangle. The intersector's own test errs in proportion to the triangle's distance from the
// ray's origin; as that origin lies on some surface of comparable coordinates, its part is bounded by the vertices'
// magnitudes and the triangle's extent.
inline Vec3 triangle_error(const Triangle& tri) {
  const Vec3 a = abs(tri.p0);
  const Vec3 b = abs(tri.p1);
  const Vec3 c = abs(tri.p2);
  const Vec3 m = {max(a.x, max(b.x, c.x)), max(a.y, max(b.y, c.y)), max(a.z, max(b.z, c.z))};
  const float extent = max_component(abs(tri.p1 - tri.p0)) + max_component(abs(tri.p2 - tri.p0));
  const float common = gamma(4) * extent;
  return {fma(gamma(5), m.x, common), fma(gamma(5), m.y, common), fma(gamma(5), m.z, common)};
}

// Moves a hit off the edges of its triangle by `margin` of the barycentric coordinates. A point next to an edge may be
// rounded beyond the neighbouring triangle, and a ray from there would leave a closed mesh.
inline Hit inset(Hit hit, float margin) {
  const float u = max(hit.u - margin, 0.0f);
  const float v = max(hit.v - margin, 0.0f);
  const float room = 1.0f - 3.0f * margin;
  const float shrink = u + v > room ? room / (u + v) : 1.0f;
  hit.u = fma(u, shrink, margin);
  hit.v = fma(v, shrink, margin);
  return hit;
}

// `rounding` is what the point will be rounded by after this, in the mesh's own space.
inline void place_on_mesh(const SceneView& scene, const Mesh& mesh, const Hit& met, float time, float rounding,
                          Surface& s) {
  const Triangle tri = triangle_of(scene, mesh, met.primitive, time);
  const Vec3 e1 = tri.p1 - tri.p0;
  const Vec3 e2 = tri.p2 - tri.p0;
  const Vec3 n0 = cross(e1, e2);
  const float doubled_area = length(n0);
  s.error = triangle_error(tri);
  const float extent = max_component(abs(e1)) + max_component(abs(e2));
  const Hit hit = inset(met, min(4.0f * (max_component(s.error) + rounding) * extent / doubled_area, 0.25f));
  s.point = fma(hit.u, e1, fma(hit.v, e2, tri.p0));
  s.normal = n0 * (1.0f / doubled_area);
  s.shading = s.normal;
  if (mesh.normal != 0) {
    const Vec3 n = vertex_normal(mesh, tri, hit.u, hit.v, time);
    const float squared = length_squared(n);
    if (squared > 0.0f && is_finite(squared)) {
      s.shading = n * (1.0f / sqrt(squared));
      if (dot(s.shading, s.normal) < 0.0f) s.shading = -s.shading;
    }
  }
}

// The point is moved onto the sphere, whose error no longer grows with the ray's length (Pharr et al. 2023, 6.8.5).
inline void place_on_sphere(const Sphere& sphere, const Ray& ray, const Hit& hit, Surface& s) {
  s.normal = normalize(fma(hit.t, ray.direction, ray.origin - sphere.center));
  s.shading = s.normal;
  s.point = fma(sphere.radius, s.normal, sphere.center);
  const float size = gamma(8) * sphere.radius;
  s.error = fma(gamma(6), abs(sphere.center), Vec3{size, size, size});
}

inline void place_on_disk(const Disk& disk, const Ray& ray, const Hit& hit, Surface& s) {
  const Vec3 p = fma(hit.t, ray.direction, ray.origin);
  s.normal = disk.normal;
  s.shading = disk.normal;
  s.point = fma(-dot(p - disk.center, disk.normal), disk.normal, p);
  const float size = gamma(6) * disk.radius;
  s.error = fma(gamma(10), abs(disk.center), Vec3{size, size, size});
}

inline void place_on_shape(const SceneView& scene, const GeometryRecord& geometry, const Ray& ray, const Hit& hit,
                           float rounding, Surface& s) {
  if (geometry.shape.tag == tag_of<Mesh>(Shapes{})) {
    place_on_mesh(scene, scene.as<Mesh>(geometry.shape), hit, ray.time, rounding, s);
  } else if (geometry.shape.tag == tag_of<Sphere>(Shapes{})) {
    place_on_sphere(scene.as<Sphere>(geometry.shape), ray, hit, s);
  } else {
    place_on_disk(scene.as<Disk>(geometry.shape), ray, hit, s);
  }
}

inline void to_world(const InstanceRecord& instance, Surface& s) {
  const Transform& m = instance.to_world;
  const Vec3 magnitude = m.magnitude(s.point);
  s.error = m.spread(s.error) + magnitude * gamma(10);
  s.point = m.point(s.point);
  s.normal = normalize(m.vector(s.normal));
  s.shading = normalize(m.vector(s.shading));
}

inline void place_on_still(const SceneView& scene, const InstanceRecord& instance, Ray ray, const Hit& hit,
                           Surface& s) {
  ray.origin = instance.to_world.point_back(ray.origin);
  ray.direction = instance.to_world.vector_back(ray.direction);
  const Transform& m = instance.to_world;
  const float scale = length({m.m[0][0], m.m[1][0], m.m[2][0]});
  const float rounding = gamma(10) * max_component(m.magnitude(fma(hit.t, ray.direction, ray.origin))) / scale;
  place_on_shape(scene, scene.geometries[hit.geometry], ray, hit, rounding, s);
  to_world(instance, s);
}

inline void place_on_moving(const SceneView& scene, const InstanceRecord& instance, Ray ray, const Hit& hit,
                            Surface& s) {
  const Moment moment = moment_of(scene, instance.motion, ray.time);
  const Placement at = placement(moment);
  ray.origin = at.to_object.point(ray.origin);
  ray.direction = at.to_object.vector(ray.direction);
  const Vec3 rounding = at.to_object.spread(rounding_at(moment, fma(hit.t, ray.direction, ray.origin)));
  place_on_shape(scene, scene.geometries[hit.geometry], ray, hit, max_component(rounding), s);
  s.error = at.to_world.spread(s.error) + rounding_at(moment, s.point);
  s.point = at.to_world.point(s.point);
  s.normal = normal_by(at.to_object, s.normal);
  s.shading = normal_by(at.to_object, s.shading);
}

// Position, error and normals on an instance. Never inlined: threads of a GPU have little memory.
ACCURAY_NOINLINE inline Surface place_on_instance(const SceneView& scene, Ray ray, Hit hit) {
  const InstanceRecord& instance = scene.instances[hit.instance];
  Surface s;
  if (instance.motion == none) {
    place_on_still(scene, instance, ray, hit, s);
  } else {
    place_on_moving(scene, instance, ray, hit, s);
  }
  return s;
}

// `hit` must have met something.
inline Surface surface_at(const SceneView& scene, const Ray& ray, const Hit& hit) {
  const GeometryRecord& geometry = scene.geometries[hit.geometry];
  Surface s;
  uint32_t lights = geometry.lights;
  if (hit.instance == none) {
    place_on_shape(scene, geometry, ray, hit, 0.0f, s);
    s.material = geometry.material;
  } else {
    s = place_on_instance(scene, ray, hit);
    const InstanceRecord& instance = scene.instances[hit.instance];
    s.material = instance.material == none ? geometry.material : instance.material;
    lights = instance.lights == none ? none : scene.lights_of_instance[instance.lights + hit.geometry - instance.first];
  }
  s.light = lights == none ? none : scene.light_of_primitive[lights + hit.primitive];
  return s;
}

}  // namespace accuray
