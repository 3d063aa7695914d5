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

ACCURAY_NOINLINE inline Part chosen_part(const SceneView& scene, Hit hit, Surface surface, float footprint, bool behind,
                                         float u) {
  Part part{surface.material, false, u};
  for (uint32_t level = 0; level < most_levels && scene.materials[part.material].composed != 0; ++level) {
    const MaterialRecord& whole = scene.materials[part.material];
    PartQuestion question{scene, whole.reads_texture_point != 0 ? texture_point(scene, hit, surface) : TexturePoint{},
                          behind != part.turned};
    question.where.footprint = footprint;
    const Part next = dispatch(Compositions{}, whole.bsdf.tag, [&](auto type) {
      return scene.as<typename decltype(type)::type>(whole.bsdf).part(question, part.u);
    });
    part = {next.material, part.turned != next.turned, next.u};
  }
  return part;
}

inline Part part_at(const SceneView& scene, const Surface& surface, const Path& path) {
  if (scene.materials[surface.material].composed == 0) [[likely]]
    return {surface.material, false, 0.0f};
  return chosen_part(scene, path.hit, surface, footprint_on(surface, path), leaves(path, surface), part_number(path));
}

// The surface with its back in front.
inline void turn(Surface& surface) {
  surface.normal = -surface.normal;
  surface.shading = -surface.shading;
}

}  // namespace accuray
