// Ray intersections of the analytic shapes, and of triangles for the intersector that needs no acceleration structure.
#pragma once

#include "kernels/geometry/shapes.h"
#include "kernels/math/rounding.h"

namespace accuray {

// Nearest t in (0, far] at which the ray meets the sphere; negative if there is none. The discriminant is taken from
// the distance between centre and ray, which keeps its digits for small and far spheres (Haines, Guenther and
// Akenine-Moeller 2019, "Precision Improvements for Ray/Sphere Intersection").
inline float intersect(const Sphere& sphere, const Ray& ray, float far) {
  const Vec3 f = ray.origin - sphere.center;
  const float a = length_squared(ray.direction);
  const float b = -dot(f, ray.direction);
  const Vec3 perpendicular = fma(b / a, ray.direction, f);
  const float discriminant = sphere.radius * sphere.radius - length_squared(perpendicular);
  if (!(discriminant >= 0.0f)) return -1.0f;
  const float c = difference_of_products(length(f), length(f), sphere.radius, sphere.radius);
  const float root = sqrt(a * discriminant);
  const float q = b + (b < 0.0f ? -root : root);
  if (q == 0.0f) return -1.0f;
  float t0 = c / q;
  float t1 = q / a;
  if (t0 > t1) {
    const float swapped = t0;
    t0 = t1;
    t1 = swapped;
  }
  if (t0 > 0.0f && t0 <= far) return t0;
  if (t1 > 0.0f && t1 <= far) return t1;
  return -1.0f;
}

// The same for a disk.
inline float intersect(const Disk& disk, const Ray& ray, float far) {
  const float approach = dot(disk.normal, ray.direction);
  if (approach == 0.0f) return -1.0f;
  const float t = dot(disk.normal, disk.center - ray.origin) / approach;
  if (!(t > 0.0f && t <= far)) return -1.0f;
  const Vec3 p = fma(t, ray.direction, ray.origin);
  return length_squared(p - disk.center) <= disk.radius * disk.radius ? t : -1.0f;
}

struct TriangleHit {
  float t, u, v;
};

// Triangle by scaled Pluecker coordinates relative to the origin: edges shared by two triangles give the same value
// with opposite sign, so no ray slips between them (Davidovic, Engelhardt, Georgiev, Slusallek and Dachsbacher 2012).
inline bool intersect_triangle(Vec3 p0, Vec3 p1, Vec3 p2, const Ray& ray, float far, TriangleHit& hit) {
  const Vec3 a = p0 - ray.origin;
  const Vec3 b = p1 - ray.origin;
  const Vec3 c = p2 - ray.origin;
  const float u = dot(cross(c + a, a - c), ray.direction);
  const float v = dot(cross(a + b, b - a), ray.direction);
  const float w = dot(cross(b + c, c - b), ray.direction);
  const bool outside = min(u, min(v, w)) < 0.0f && max(u, max(v, w)) > 0.0f;
  const float sum = u + v + w;
  if (outside || sum == 0.0f) return false;
  const Vec3 normal = cross(p1 - p0, p2 - p0);
  const float approach = dot(normal, ray.direction);
  if (approach == 0.0f) return false;
  const float t = dot(normal, a) / approach;
  if (!(t > 0.0f && t <= far)) return false;
  hit = {t, u / sum, v / sum};
  return true;
}

}  // namespace accuray
