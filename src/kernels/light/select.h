// Which light a shading point asks: one of the light tree, or one of those infinitely far away beside it.
#pragma once

#include "kernels/light/list.h"
#include "kernels/light/moving.h"
#include "kernels/light/tree.h"

namespace accuray {

// Share of the choices that the tree and the distant lights have equally; the rest is by what they may send to the
// point. It is what an estimate that knows no shadows may cost: indoors a sky is hidden, outdoors a lamp is dim.
constexpr float equal_share = 0.5f;

// Chances of the tree and of each distant light, in one: a sum of equal shares and of estimated irradiances.
struct DistantShares {
  uint32_t count;
  float tree;   // chance of the tree
  float equal;  // of each distant light
  float scale;  // and this for its irradiance

  float of(const DistantLight& light) const { return fma(scale, light.irradiance, equal); }
};

ACCURAY_NOINLINE inline DistantShares distant_shares(const SceneView& scene, Vec3 point, Vec3 normal) {
  const uint32_t count = scene.root->distant_lights.count;
  const float near =
      scene.root->light_nodes.count == 0 ? 0.0f : sum(tree::weights(scene, scene.light_nodes[0], point, normal));
  float total = near;
  for (uint32_t i = 0; i < count; ++i) total += scene.distant_lights[i].irradiance;
  const float parts = static_cast<float>(near > 0.0f ? count + 1 : count);
  const float fixed = total > 0.0f ? equal_share : 1.0f;
  DistantShares shares{count, 0.0f, fixed / parts, total > 0.0f ? (1.0f - fixed) / total : 0.0f};
  if (near > 0.0f) shares.tree = fma(shares.scale, near, shares.equal);
  return shares;
}

// Of a scene with several lights.
ACCURAY_NOINLINE inline LightChoice choose_among(const SceneView& scene, Vec3 point, Vec3 normal, float u) {
  if (scene.root->distant_lights.count == 0) [[likely]] {
    if (scene.root->light_nodes.count == 0) return {none, 0.0f};
    return choose_in_tree(scene, point, normal, u);
  }
  const DistantShares shares = distant_shares(scene, point, normal);
  if (u < shares.tree) {
    const LightChoice near = choose_in_tree(scene, point, normal, min(u / shares.tree, one_minus_epsilon));
    return {near.light, near.probability * shares.tree};
  }
  u -= shares.tree;
  uint32_t i = 0;
  for (; i + 1 < shares.count; ++i) {
    const float share = shares.of(scene.distant_lights[i]);
    if (u < share) break;
    u -= share;
  }
  return {scene.distant_lights[i].light, shares.of(scene.distant_lights[i])};
}
ACCURAY_NOINLINE inline float probability_among(const SceneView& scene, Vec3 point, Vec3 normal, uint32_t light) {
  const uint32_t trail = scene.light_trails[light];
  if (trail == none) return 0.0f;
  if (scene.root->distant_lights.count == 0) [[likely]]
    return probability_in_tree(scene, point, normal, trail);
  const DistantShares shares = distant_shares(scene, point, normal);
  if ((trail & tree::beside) != 0) return shares.of(scene.distant_lights[trail & ~tree::beside]);
  return shares.tree == 0.0f ? 0.0f : probability_in_tree(scene, point, normal, trail) * shares.tree;
}

// A light for a point, chosen with u in [0, 1). `normal` faces the side that light is gathered from; zero: from both.
inline LightChoice choose_light(const SceneView& scene, Vec3 point, Vec3 normal, float /*time*/, float u) {
  const uint32_t count = scene.root->lights.count;
  if (count <= 1) return {count == 0 ? none : 0u, 1.0f};
  return choose_among(scene, point, normal, u);
}

// The probability with which choose_light() chooses the light, exactly.
inline float choice_probability(const SceneView& scene, Vec3 point, Vec3 normal, float /*time*/, uint32_t light) {
  return scene.root->lights.count == 1 ? 1.0f : probability_among(scene, point, normal, light);
}

inline LightSample sample_still(const SceneView& scene, const LightRecord& record, Vec3 reference, Vec2 u) {
  return dispatch(Lights{}, record.light.tag, [&](auto type) {
    const auto& chosen = scene.as<typename decltype(type)::type>(record.light);
    if constexpr (requires { chosen.sample(scene, reference, u); }) {
      return chosen.sample(scene, reference, u);
    } else {
      return chosen.sample(reference, u);
    }
  });
}

inline LightSample sample_light(const SceneView& scene, uint32_t light, Vec3 reference, float time, Vec2 u) {
  const LightRecord& record = scene.lights[light];
  LightSample s = record.motion == none ? sample_still(scene, record, reference, u)
                                        : sample_moving(scene, record, reference, time, u);
  const bool faces_away = dot(s.normal, s.wi) >= 0.0f && length_squared(s.normal) > 0.0f;
  if (faces_away && record.both_sides == 0) s.scale = 0.0f;
  return s;
}

inline float light_pdf(const SceneView& scene, uint32_t light, Vec3 reference, float time, Vec3 wi, const Surface& at) {
  const LightRecord& record = scene.lights[light];
  if (record.motion != none) [[unlikely]]
    return moving_pdf(scene, record, reference, time, wi, at.point, at.normal);
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
