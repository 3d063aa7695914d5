// Step choose: the part of a composed material that shows where a path has met it.
#pragma once

#include "kernels/bsdf/composition.h"
#include "kernels/integrator/bodies.h"

namespace accuray {

// A number of the sample for this vertex that nothing else uses. Inside bodies a path may meet several surfaces before
// it scatters, so there it is hashed from what was met as well.
inline float part_number(const Path& path) {
  if (path.inside.count == 0) return path.sampler.draw(decision_set(path))[3];
  const uint32_t met = hash(path.hit.geometry, path.hit.instance, path.hit.primitive);
  return uniform(hash(path.sampler.key, path.sampler.index, path.depth, met));
}

ACCURAY_NOINLINE inline Part chosen_part(const SceneView& scene, Hit hit, Surface surface, Vec3 direction, float time,
                                         float footprint, float u) {
  const bool behind = dot(direction, surface.normal) > 0.0f;
  const float cosine = min(abs(dot(direction, surface.shading)), 1.0f);
  Part part{surface.material, false, u, 1.0f};
  for (uint32_t level = 0; level < most_levels && scene.materials[part.material].composed != 0; ++level) {
    const MaterialRecord& whole = scene.materials[part.material];
    const TexturePoint where =
        whole.reads_texture_point != 0 ? texture_point(scene, hit, surface, time) : TexturePoint{};
    PartQuestion question{scene, where, behind != part.turned, cosine};
    question.where.footprint = footprint;
    const Part next = dispatch(Compositions{}, whole.bsdf.tag, [&](auto type) {
      return scene.as<typename decltype(type)::type>(whole.bsdf).part(question, part.u);
    });
    part = {next.material, part.turned != next.turned, next.u, part.scale * next.scale};
  }
  return part;
}

inline Part part_at(const SceneView& scene, const Surface& surface, const Path& path) {
  if (scene.materials[surface.material].composed == 0) [[likely]]
    return {surface.material, false, 0.0f, 1.0f};
  return chosen_part(scene, path.hit, surface, path.ray.direction, path.ray.time, footprint_on(surface, path),
                     part_number(path));
}

// From here on the path sees the part: the surface turned around if that is what it shows.
inline void show(const Part& part, Surface& surface, Path& path) {
  path.throughput *= part.scale;
  if (!part.turned) [[likely]]
    return;
  surface.normal = -surface.normal;
  surface.shading = -surface.shading;
}

}  // namespace accuray
