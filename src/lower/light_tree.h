// The light tree of a scene: built once, from where the lights are, where they send light, and how much.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/light/light.h"
#include "kernels/scene_view.h"

namespace accuray {

// A light at a finite distance; `power` > 0, of both sides if both emit.
struct Emitter {
  uint32_t light;
  LightBounds bounds;
  double power;
  bool both_sides;
};

// A light infinitely far away; `irradiance` > 0, in the unit of power per m^2.
struct DistantEmitter {
  uint32_t light;
  double irradiance;
};

struct LightTree {
  std::vector<LightNode> nodes;
  std::vector<uint32_t> trails;  // one for each light of the scene
  std::vector<DistantLight> distant;
};

// The tree over `emitters`, each of which is one of `lights` lights; those that are neither here nor distant emit
// nothing. Groups are split where the power times the variance of both halves, of positions and normals, is least: that
// is what the surface area orientation heuristic (Conty Estevez and Kulla 2018) becomes for groups that are known by
// their means. In O(n log n) for n lights, and the same way every time.
LightTree build_light_tree(const std::vector<Emitter>& emitters, const std::vector<DistantEmitter>& distant,
                           size_t lights);

}  // namespace accuray
