// Surfaces that let part of the light through, unchanged in direction and colour: cut-out leaves, nets, veils.
//
// A ray is passed or stopped whole at each of them, by a number hashed from the sample, the vertex, how many surfaces
// the ray has crossed and what it meets: light that several layers let through is the product of their transparencies
// in expectation, whatever order an intersector finds them in.
#pragma once

#include "kernels/accel/accel.h"
#include "kernels/sampling/hash.h"
#include "kernels/texture/list.h"

namespace accuray {

inline bool is_always_opaque(const MaterialRecord& material) {
  return material.opacity.texture == none && material.opacity.value >= 1.0f;
}

// Does the surface at a hit let this ray through?
inline bool is_passed(const SceneView& scene, const Hit& hit, const Surface& surface, float time, uint32_t key) {
  const MaterialRecord& material = scene.materials[surface.material];
  if (is_always_opaque(material)) return false;
  const RealRef& opacity = material.opacity;
  const float value =
      opacity.texture == none ? opacity.value : textured_real(scene, opacity, texture_point(scene, hit, surface, time));
  return uniform(hash(key, hit.geometry, hit.instance, hit.primitive)) >= value;
}

// More surfaces than any sensible ray crosses: the one beyond stops it.
constexpr uint32_t most_crossings = 1u << 16;

// The nearest hit that stops a ray, and the ray's origin behind what it passed.
struct Stop {
  Hit hit;
  Vec3 origin;
};

// Only for scenes with such surfaces.
template <Accel A>
ACCURAY_NOINLINE inline Stop closest_opaque(const SceneView& scene, const A& accel, Ray ray, uint32_t key) {
  Hit hit = accel.closest(ray);
  for (uint32_t crossed = 0; hit.geometry != none && crossed < most_crossings; ++crossed) {
    const Surface surface = surface_at(scene, ray, hit);
    if (!is_passed(scene, hit, surface, ray.time, hash(key, crossed))) break;
    ray.origin = offset_origin(surface.point, surface.error, surface.normal, ray.direction);
    hit = accel.closest(ray);
  }
  return {hit, ray.origin};
}

// The same between two points: does all that lies between let the ray through? `to` counts if the ray ends.
template <Accel A>
ACCURAY_NOINLINE inline float opaque_transmittance(const SceneView& scene, const A& accel, Ray ray, Vec3 to,
                                                   uint32_t key) {
  for (uint32_t crossed = 0; crossed < most_crossings; ++crossed) {
    const Hit hit = accel.closest(ray);
    if (hit.geometry == none) return 1.0f;
    const Surface surface = surface_at(scene, ray, hit);
    if (!is_passed(scene, hit, surface, ray.time, hash(key, crossed))) return 0.0f;
    ray.origin = offset_origin(surface.point, surface.error, surface.normal, ray.direction);
    if (ray.far != infinity) ray.direction = to - ray.origin;
  }
  return 0.0f;
}

}  // namespace accuray
