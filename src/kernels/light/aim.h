// Lights at a point that face somewhere.
#pragma once

#include "kernels/light/light.h"
#include "kernels/schema.h"

namespace accuray {

// Which way such a light faces; the lowering turns either into a unit vector.
constexpr auto aim_params() {
  return param_list(Param{.name = "direction",
                          .kind = Kind::vec,
                          .doc = "Where it faces, of any length.",
                          .preset = "[0, -1, 0]",
                          .group = "aim:direction",
                          .animatable = true},
                    Param{.name = "target",
                          .kind = Kind::vec,
                          .doc = "The point that it faces.",
                          .unit = "m",
                          .group = "aim:target",
                          .animatable = true});
}

// A sample of a light at a point without its own pattern: scale is 1/d^2.
inline LightSample sample_point(Vec3 reference, Vec3 position) {
  LightSample s = sample_towards(reference, position, {0, 0, 0}, {0, 0, 0}, 1.0f);
  if (s.distance == 0.0f) return no_light();
  s.pdf = 1.0f;
  s.scale = 1.0f / (s.distance * s.distance);
  return s;
}

}  // namespace accuray
