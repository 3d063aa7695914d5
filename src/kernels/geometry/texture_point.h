// Where a hit lies in its surface's own coordinates: what textures are read at and anisotropic materials turn with.
#pragma once

#include "kernels/geometry/surface.h"
#include "kernels/math/functions.h"

namespace accuray {

// Conventions
//   - `uv` are a mesh's own texture coordinates where it has some, else the hit's barycentric ones; on a sphere u runs
//     once around its y axis and v from the south pole to the north; on a disk both run over its bounding square.
//   - `point` is in the shape's own space: that of the prototype for an instance, else the world.
//   - `geometry`, `primitive`, `on_triangle` are those of the hit, for what a mesh has at its vertices.
//   - `footprint` is the diameter in metres of what shall be averaged, along the surface; 0: a point.
//   - `dpdu` and `dpdv` are derivatives of the point by them, in world space; never zero, and never parallel.
struct TexturePoint {
  Vec2 uv;
  Vec3 dpdu, dpdv;
  Vec3 point = {0.0f, 0.0f, 0.0f};
  uint32_t geometry = none;  // none: on no shape
  uint32_t primitive = 0;
  Vec2 on_triangle = {0.0f, 0.0f};  // barycentric coordinates of vertices 1 and 2
  float footprint = 0.0f;
};

// Two tangents of no particular direction, for where the coordinates give none.
inline void any_tangents(Vec3 normal, TexturePoint& p) {
  const Frame frame = Frame::around(normal);
  p.dpdu = frame.x;
  p.dpdv = frame.y;
}

inline TexturePoint point_on_mesh(const SceneView& scene, const Mesh& mesh, const Hit& hit, Vec3 normal, float time) {
  const Triangle tri = triangle_of(scene, mesh, hit.primitive, time);
  const Vec3 e1 = tri.p1 - tri.p0;
  const Vec3 e2 = tri.p2 - tri.p0;
  if (mesh.uv == 0) return {{hit.u, hit.v}, e1, e2};
  const auto uv = [&](const float* vertex) { return Vec2{vertex[mesh.uv], vertex[mesh.uv + 1]}; };
  const Vec2 a = uv(tri.v0);
  const Vec2 b = uv(tri.v1);
  const Vec2 c = uv(tri.v2);
  const Vec2 ab = {b.x - a.x, b.y - a.y};
  const Vec2 ac = {c.x - a.x, c.y - a.y};
  TexturePoint p;
  p.uv = {fma(hit.u, ab.x, fma(hit.v, ac.x, a.x)), fma(hit.u, ab.y, fma(hit.v, ac.y, a.y))};
  const float determinant = difference_of_products(ab.x, ac.y, ab.y, ac.x);
  const float scale = 1.0f / determinant;
  p.dpdu = (e1 * ac.y - e2 * ab.y) * scale;
  p.dpdv = (e2 * ab.x - e1 * ac.x) * scale;
  const float squared = length_squared(cross(p.dpdu, p.dpdv));
  if (!(squared > 0.0f) || !is_finite(squared)) any_tangents(normal, p);
  return p;
}

// `direction` leads from the centre to the hit.
inline TexturePoint point_on_sphere(Vec3 direction, float radius) {
  const float u = atan2(-direction.z, direction.x) * (0.5f * inv_pi);
  const float v = acos(min(max(-direction.y, -1.0f), 1.0f)) * inv_pi;
  const float around = sqrt(direction.x * direction.x + direction.z * direction.z);
  TexturePoint p{{u < 0.0f ? u + 1.0f : u, v}, {}, {}};
  if (around < 1e-6f) {
    any_tangents(direction, p);
    return p;
  }
  p.dpdu = Vec3{direction.z, 0.0f, -direction.x} * (2.0f * pi * radius);
  p.dpdv = Vec3{-direction.x * direction.y / around, around, -direction.z * direction.y / around} * (pi * radius);
  return p;
}

inline TexturePoint point_on_disk(const Disk& disk, Vec3 point) {
  const Frame frame = Frame::around(disk.normal);
  const Vec3 p = frame.to_local(point - disk.center);
  const float scale = 0.5f / disk.radius;
  return {
      {fma(p.x, scale, 0.5f), fma(p.y, scale, 0.5f)}, frame.x * (2.0f * disk.radius), frame.y * (2.0f * disk.radius)};
}

// A vector at a hit in the shape's own space.
inline Vec3 into_object(const SceneView& scene, const Hit& hit, float time, Vec3 v) {
  if (hit.instance == none) return v;
  const InstanceRecord& instance = scene.instances[hit.instance];
  if (instance.motion == none) return instance.to_world.vector_back(v);
  return into_moving(scene, instance.motion, {{0.0f, 0.0f, 0.0f}, v, infinity, time}).direction;
}

// `point` and `normal` in the shape's own space.
inline TexturePoint point_on_shape(const SceneView& scene, const Hit& hit, Vec3 point, Vec3 normal, float time) {
  const Tagged shape = scene.geometries[hit.geometry].shape;
  TexturePoint p;
  if (shape.tag == tag_of<Mesh>(Shapes{})) {
    p = point_on_mesh(scene, scene.as<Mesh>(shape), hit, normal, time);
  } else if (shape.tag == tag_of<Sphere>(Shapes{})) {
    const Sphere& sphere = scene.as<Sphere>(shape);
    p = point_on_sphere(normalize(point - sphere.center), sphere.radius);
  } else {
    p = point_on_disk(scene.as<Disk>(shape), point);
  }
  p.point = point;
  p.geometry = hit.geometry;
  p.primitive = hit.primitive;
  p.on_triangle = {hit.u, hit.v};
  return p;
}

// Never inlined: threads of a GPU have little memory.
ACCURAY_NOINLINE inline TexturePoint point_on_instance(const SceneView& scene, Hit hit, Vec3 point, Vec3 normal,
                                                       float time) {
  const InstanceRecord& instance = scene.instances[hit.instance];
  Transform to_world = instance.to_world;
  if (instance.motion != none) {
    const Placement at = placement(moment_of(scene, instance.motion, time));
    to_world = at.to_world;
    point = at.to_object.point(point);
    normal = normal_by(at.to_world, normal);
  } else {
    point = to_world.point_back(point);
    normal = normalize(to_world.vector_back(normal));
  }
  TexturePoint p = point_on_shape(scene, hit, point, normal, time);
  p.dpdu = to_world.vector(p.dpdu);
  p.dpdv = to_world.vector(p.dpdv);
  return p;
}

// `hit` must have met something at this time, and `surface` be what surface_at() made of it.
inline TexturePoint texture_point(const SceneView& scene, const Hit& hit, const Surface& surface, float time) {
  if (hit.instance == none) return point_on_shape(scene, hit, surface.point, surface.normal, time);
  return point_on_instance(scene, hit, surface.point, surface.normal, time);
}

}  // namespace accuray
