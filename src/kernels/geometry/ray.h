// Rays and what they hit.
#pragma once

#include "kernels/math/constants.h"
#include "kernels/math/vec.h"

namespace accuray {

constexpr uint32_t none = 0xffffffffu;

// Points o + t d for t in [0, far]. The origin is already off its surface, so no ray needs a lower bound.
struct Ray {
  Vec3 origin;
  Vec3 direction;
  float far = infinity;
  float time = 0.0f;
};

// The closest intersection: which primitive of which geometry, and where on it.
struct Hit {
  float t = infinity;
  float u = 0.0f, v = 0.0f;  // barycentric coordinates of vertices 1 and 2
  uint32_t primitive = 0;
  uint32_t geometry = none;  // index in SceneView::geometries; none: the ray left the scene
  uint32_t instance = none;  // index in SceneView::instances; none: not instanced
};

}  // namespace accuray
