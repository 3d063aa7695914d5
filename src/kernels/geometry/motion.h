// Where things that move are at a moment of the shutter interval: instances, and the camera.
#pragma once

#include "kernels/math/rounding.h"
#include "kernels/scene_view.h"

namespace accuray {

// Conventions
//   - A motion is a row of keys at equal steps of time, the first where the shutter opens and the last where it closes.
//     Between two of them every entry of the matrix changes in a straight line, as Embree has it, so that a point moves
//     on a straight line at an even speed. The lowering takes as many keys as the true motion needs.
//   - A matrix between two rotations is none: it shrinks a little. So nothing here takes a placement for rigid.
struct Placement {
  Transform to_world;
  Transform to_object;
  float determinant;
};

// Roundings of an entry of a placement, of its inverse and of the intersector's own, together.
constexpr int placement_roundings = 20;

// The inverse by cofactors; `determinant` is that of the linear part.
inline Transform inverse_of(const Transform& t, float& determinant) {
  const Vec3 x = {t.m[0][0], t.m[1][0], t.m[2][0]};
  const Vec3 y = {t.m[0][1], t.m[1][1], t.m[2][1]};
  const Vec3 z = {t.m[0][2], t.m[1][2], t.m[2][2]};
  const Vec3 yz = cross(y, z);
  determinant = dot(x, yz);
  const float scale = 1.0f / determinant;
  const Vec3 a = yz * scale;
  const Vec3 b = cross(z, x) * scale;
  const Vec3 c = cross(x, y) * scale;
  const Vec3 move = {t.m[0][3], t.m[1][3], t.m[2][3]};
  return {{{a.x, a.y, a.z, -dot(a, move)}, {b.x, b.y, b.z, -dot(b, move)}, {c.x, c.y, c.z, -dot(c, move)}}};
}

// One of equal segments of the shutter interval that a time in [0, 1] lies in, and how far along.
struct Step {
  uint32_t segment;
  float share;
};
inline Step step_at(float time, uint32_t segments) {
  const float scaled = time * static_cast<float>(segments);
  uint32_t segment = static_cast<uint32_t>(max(scaled, 0.0f));
  if (segment >= segments) segment = segments - 1;
  return {segment, scaled - static_cast<float>(segment)};
}

// The keys about a time in [0, 1], and how far it is from the first of them to the second.
struct Moment {
  const Transform* first;
  const Transform* second;
  float share;
};
inline Moment moment_of(const SceneView& scene, uint32_t motion, float time) {
  const MotionRecord& record = scene.motions[motion];
  const Step step = step_at(time, record.count - 1);
  const Transform* before = scene.motion_keys + record.first + step.segment;
  return {before, before + 1, step.share};
}

inline Transform transform_at(const Moment& at) {
  Transform t;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      t.m[row][column] = fma(1.0f - at.share, at.first->m[row][column], at.share * at.second->m[row][column]);
    }
  }
  return t;
}

inline Placement placement(const Moment& at) {
  Placement p;
  p.to_world = transform_at(at);
  p.to_object = inverse_of(p.to_world, p.determinant);
  return p;
}

// A bound of what rounds on a point's way into the world: in proportion to all that is summed, of both keys.
inline Vec3 rounding_at(const Moment& at, Vec3 point) {
  return max(at.first->magnitude(point), at.second->magnitude(point)) * gamma(placement_roundings);
}

// A normal under the inverse of a transform, transposed; of unit length.
inline Vec3 normal_by(const Transform& inverse, Vec3 n) {
  const auto& m = inverse.m;
  return normalize({fma(m[0][0], n.x, fma(m[1][0], n.y, m[2][0] * n.z)),
                    fma(m[0][1], n.x, fma(m[1][1], n.y, m[2][1] * n.z)),
                    fma(m[0][2], n.x, fma(m[1][2], n.y, m[2][2] * n.z))});
}

// A ray in the space of a moving instance's prototypes.
inline Ray into_moving(const SceneView& scene, uint32_t motion, Ray ray) {
  const Moment at = moment_of(scene, motion, ray.time);
  float determinant;
  const Transform to_object = inverse_of(transform_at(at), determinant);
  ray.origin = to_object.point(ray.origin);
  ray.direction = to_object.vector(ray.direction);
  return ray;
}

// A ray of a camera that moves, given where the camera stands without its motion.
ACCURAY_NOINLINE inline Ray carried_by(const SceneView& scene, uint32_t motion, Ray ray) {
  const Transform to_world = transform_at(moment_of(scene, motion, ray.time));
  ray.origin = to_world.point(ray.origin);
  ray.direction = normalize(to_world.vector(ray.direction));
  return ray;
}

}  // namespace accuray
