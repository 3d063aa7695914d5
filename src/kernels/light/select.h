// Which light a shading point asks: by power for now. A better choice replaces these two functions only.
#pragma once

#include "kernels/light/list.h"

namespace accuray {

struct LightChoice {
  uint32_t light;  // none if the scene has no light
  float probability;
};

// Point, normal and time are what a light tree will choose by; selection by power looks at none of them.
inline LightChoice choose_light(const SceneView& scene, Vec3 /*point*/, Vec3 /*normal or zero*/, float /*time*/,
                                float u) {
  const uint32_t count = scene.root->lights.count;
  if (count == 0) return {none, 0.0f};
  uint32_t low = 0;
  uint32_t high = count;
  while (high - low > 1) {
    const uint32_t middle = (low + high) / 2;
    if (scene.light_cdf[middle] <= u) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return {low, scene.light_cdf[low + 1] - scene.light_cdf[low]};
}

inline float choice_probability(const SceneView& scene, Vec3, Vec3, float, uint32_t light) {
  return scene.light_cdf[light + 1] - scene.light_cdf[light];
}

inline LightSample sample_light(const SceneView& scene, uint32_t light, Vec3 reference, Vec2 u) {
  const LightRecord& record = scene.lights[light];
  LightSample s = dispatch(Lights{}, record.light.tag, [&](auto type) {
    const auto& chosen = scene.as<typename decltype(type)::type>(record.light);
    if constexpr (requires { chosen.sample(scene, reference, u); }) {
      return chosen.sample(scene, reference, u);
    } else {
      return chosen.sample(reference, u);
    }
  });
  const bool faces_away = dot(s.normal, s.wi) >= 0.0f && length_squared(s.normal) > 0.0f;
  if (faces_away && record.both_sides == 0) s.scale = 0.0f;
  return s;
}

inline float light_pdf(const SceneView& scene, uint32_t light, Vec3 reference, Vec3 wi, const Surface& at) {
  const LightRecord& record = scene.lights[light];
  return dispatch(Lights{}, record.light.tag, [&](auto type) {
    const auto& met = scene.as<typename decltype(type)::type>(record.light);
    if constexpr (requires { met.pdf(scene, reference, wi, at); }) {
      return met.pdf(scene, reference, wi, at);
    } else {
      return met.pdf(reference, wi, at);
    }
  });
}

inline bool is_delta_light(uint32_t tag) {
  return dispatch(Lights{}, tag, [](auto type) { return decltype(type)::type::delta; });
}

inline bool is_infinite_light(uint32_t tag) {
  return dispatch(Lights{}, tag, [](auto type) { return decltype(type)::type::infinite; });
}

}  // namespace accuray
