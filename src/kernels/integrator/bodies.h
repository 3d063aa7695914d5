// The steps of a path at the surfaces of dielectric bodies: absorption, going in and out, surfaces that are not there.
#pragma once

#include "kernels/integrator/path_state.h"

namespace accuray {

// Whether the path meets the back of the surface, which is where it leaves a body.
inline bool leaves(const Path& path, const Surface& surface) { return dot(path.ray.direction, surface.normal) > 0.0f; }

// Length of the way from the last vertex: that to the surface's plane. The ray itself starts off its vertex, which is
// a good part of the way through a pane that is thin beside its size.
inline float way_to(const Surface& surface, const Path& path) {
  const Vec3 way = surface.point - path.origin;
  const float cosine = dot(path.ray.direction, surface.normal);
  return abs(cosine) > 1e-3f ? abs(dot(way, surface.normal) / cosine) : length(way);
}

// Step travel: what the body absorbs that the path went through. A path that meets the back of a body without having
// entered it began in there.
inline void travel(const SceneView& scene, const MaterialRecord& material, const Surface& surface, Path& path) {
  if (path.inside.count == 0 && (material.interior == none || !leaves(path, surface))) return;
  const uint32_t filling = path.inside.count == 0 ? material.interior : path.inside.filling(scene);
  path.throughput *= share_after(scene, filling, way_to(surface, path), path.wl);
}

// Step cross: goes through the surface of a body.
inline void cross_surface(const MaterialRecord& material, const Surface& surface, Path& path) {
  if (material.interior == none) return;
  if (leaves(path, surface)) {
    path.inside.leave(material.interior);
  } else {
    path.inside.enter(material.interior);
  }
}

// What lies on the far side of the surface's front; none: vacuum, or the material bounds no body.
inline uint32_t exterior_at(const SceneView& scene, const MaterialRecord& material, const Surface& surface,
                            const Path& path) {
  if (material.interior == none) return none;
  Interiors inside = path.inside;
  if (leaves(path, surface)) inside.leave(material.interior);
  return inside.filling(scene);
}

// Step pass: goes straight on where another body hides the surface; true if it does. sample_light() finds nothing
// beyond, so what the path meets there counts whole.
inline bool pass_hidden(const SceneView& scene, const MaterialRecord& material, const Surface& surface,
                        uint32_t exterior, Path& path) {
  if (material.interior == none || !is_hidden(scene, material.interior, exterior)) return false;
  cross_surface(material, surface, path);
  path.ray.origin = offset_origin(surface.point, surface.error, surface.normal, path.ray.direction);
  widen_cone(surface.point, 0.0f, path);
  path.origin = surface.point;
  path.bsdf_pdf = 0.0f;
  return true;
}

}  // namespace accuray
