// Bump maps: the normal of a surface that is raised by a texture's value.
#pragma once

#include "kernels/texture/list.h"

namespace accuray {

// How far to go along u and v, in the shape's own coordinates, to see a texture's value change: its own smallest step.
struct BumpStep {
  float u, v;
};

inline BumpStep bump_step(const SceneView& scene, uint32_t texture, Vec3 dpdu, Vec3 dpdv) {
  const Tagged record = scene.textures[texture];
  return dispatch(Textures{}, record.tag, [&](auto type) {
    using Texture = typename decltype(type)::type;
    const Texture& t = scene.as<Texture>(record);
    if constexpr (Texture::reads_uv) {
      const auto& m = t.map.m;
      return BumpStep{t.step() / sqrt(fma(m[0][0], m[0][0], m[1][0] * m[1][0])),
                      t.step() / sqrt(fma(m[0][1], m[0][1], m[1][1] * m[1][1]))};
    } else {
      return BumpStep{t.step() / length(dpdu), t.step() / length(dpdv)};
    }
  });
}

// The shading normal of the surface raised along it by `height` times the texture's red channel: the normal less the
// surface gradient of the height (Mikkelsen 2010), from central differences.
ACCURAY_NOINLINE inline Vec3 bumped_normal(const SceneView& scene, uint32_t texture, float height, Hit hit, float time,
                                           Vec3 shading, TexturePoint p) {
  const Vec3 along_u = into_object(scene, hit, time, p.dpdu);
  const Vec3 along_v = into_object(scene, hit, time, p.dpdv);
  const BumpStep step = bump_step(scene, texture, along_u, along_v);
  const auto raised = [&](float du, float dv) {
    TexturePoint q = p;
    q.uv = {p.uv.x + du, p.uv.y + dv};
    q.point = fma(du, along_u, fma(dv, along_v, p.point));
    return height * texture_value(scene, texture, q)[0];
  };
  const float by_u = (raised(step.u, 0.0f) - raised(-step.u, 0.0f)) / (2.0f * step.u);
  const float by_v = (raised(0.0f, step.v) - raised(0.0f, -step.v)) / (2.0f * step.v);
  const Vec3 across_v = cross(p.dpdv, shading);
  const Vec3 across_u = cross(shading, p.dpdu);
  const Vec3 n = shading - (by_u * across_v + by_v * across_u) * (1.0f / dot(p.dpdu, across_v));
  const float squared = length_squared(n);
  return squared > 0.0f && is_finite(squared) ? n * (1.0f / sqrt(squared)) : shading;
}

}  // namespace accuray
