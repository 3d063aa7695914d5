// What a ray meets that leaves the scene.
#pragma once

#include "kernels/integrator/steps.h"

namespace accuray {

// The sum of the infinite lights in a direction, weighted, and whether any of them is there.
struct Beyond {
  Spectrum radiance;
  bool covered;
};

// Never inlined: it holds the code of all those lights.
ACCURAY_NOINLINE inline Beyond beyond(const SceneView& scene, Strategy strategy, bool seen_by_camera, Departure from,
                                      Vec3 wi, Wavelengths wl) {
  Beyond sum = {lanes(0.0f), false};
  for (uint32_t i = 0; i < scene.root->infinite_lights.count; ++i) {
    const InfiniteRecord& infinite = scene.infinite_lights[i];
    if (seen_by_camera && infinite.hidden != 0) continue;
    const Spectrum radiance = radiance_met(scene, infinite, wi, wl);
    if (infinite.partial != 0 && is_black(radiance)) continue;
    sum.covered = true;
    const float weight = hit_weight(scene, strategy, from, wi, infinite.light, Surface{});
    sum.radiance = fma(lanes(weight), radiance, sum.radiance);
  }
  return sum;
}

// Step shade_miss: the ray left the scene.
inline void shade_miss(const SceneView& scene, Strategy strategy, Path& path) {
  path.alive = false;
  const bool seen_by_camera = path.depth == 0;
  if (scene.root->infinite_lights.count != 0) {
    const Beyond met = beyond(scene, strategy, seen_by_camera, departure(path), path.ray.direction, path.wl);
    path.radiance = fma(path.throughput, met.radiance, path.radiance);
    if (met.covered) return;
  }
  if (seen_by_camera) path.seen = false;
}

}  // namespace accuray
