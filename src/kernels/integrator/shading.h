// Where the BSDF of a hit reads its values, and the frame that its directions are in.
#pragma once

#include "kernels/integrator/parts.h"
#include "kernels/texture/bump.h"
#include "kernels/texture/normal_map.h"

namespace accuray {

inline ShadingPoint shading_point(const SceneView& scene, const MaterialRecord& material, const Path& path,
                                  const Surface& surface, uint32_t exterior) {
  const Spectrum before =
      material.interior == none ? lanes(1.0f) : exterior_ior(scene, material.interior, exterior, path.wl);
  // What stochastic BSDFs draw from: a combination only, which they hash first.
  const uint32_t seed = path.sampler.key + path.sampler.index * 0x9e3779b9u + path.depth * 0x85ebca6bu;
  const bool behind = leaves(path, surface);
  if (material.reads_texture_point == 0) return {scene, path.wl, TexturePoint{}, before, seed, behind};
  ShadingPoint point{scene, path.wl, texture_point(scene, path.hit, surface, path.ray.time), before, seed, behind};
  point.where.footprint = footprint_on(surface, path);
  return point;
}
inline Frame shading_frame(const SceneView& scene, const MaterialRecord& material, const Surface& surface,
                           const ShadingPoint& p, const Path& path) {
  Vec3 normal = surface.shading;
  if (material.normal_map != none) [[unlikely]]
    normal = mapped_normal(scene, material, normal, p.where);
  if (material.bump_map != none) [[unlikely]]
    normal = bumped_normal(scene, material.bump_map, material.bump_height, path.hit, path.ray.time, normal, p.where);
  if (normal.x != surface.normal.x || normal.y != surface.normal.y || normal.z != surface.normal.z)
    normal = facing_normal(surface.normal, normal, -path.ray.direction);
  return material.oriented == 0 ? Frame::around(normal) : Frame::along(normal, p.where.dpdu);
}

// The side that a surface gathers light from when seen from `cos_viewer`, as its normal; zero: from both.
inline Vec3 gathering_normal(const MaterialRecord& material, const Frame& frame, float cos_viewer) {
  if (material.transmits != 0) return {0.0f, 0.0f, 0.0f};
  return cos_viewer < 0.0f ? -frame.z : frame.z;
}

}  // namespace accuray
