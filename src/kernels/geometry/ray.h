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

// How wide the part of the scene is that a ray stands for: its diameter at the ray's origin, and what it grows by per
// unit of way (Amanatides 1984, "Ray Tracing with Cones"). Zero where nothing asks for it.
struct Cone {
  float width = 0.0f;
  float spread = 0.0f;

  bool is_ray() const { return width == 0.0f && spread == 0.0f; }
  float width_after(float way) const { return fma(spread, way, width); }
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
