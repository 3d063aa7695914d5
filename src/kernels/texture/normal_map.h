// Shading normals: what a normal map makes of the interpolated one, and how far it may lean from the viewer.
#pragma once

#include "kernels/texture/list.h"

namespace accuray {

// Derivatives of the point by a texture's own coordinates, after its UvMap.
inline void turn_to_texture(const SceneView& scene, uint32_t texture, TexturePoint& p) {
  const Tagged record = scene.textures[texture];
  dispatch(Textures{}, record.tag, [&](auto type) {
    using Texture = typename decltype(type)::type;
    if constexpr (Texture::reads_uv) {
      const auto& m = scene.as<Texture>(record).map.m;
      const float determinant = difference_of_products(m[0][0], m[1][1], m[0][1], m[1][0]);
      if (determinant == 0.0f) return false;
      const float scale = 1.0f / determinant;
      const Vec3 dpdu = (p.dpdu * m[1][1] - p.dpdv * m[1][0]) * scale;
      p.dpdv = (p.dpdv * m[0][0] - p.dpdu * m[0][1]) * scale;
      p.dpdu = dpdu;
    }
    return true;
  });
}

// The normal that a map gives, in the frame of the shading normal and the texture's u direction. Its colours 0 to 1 are
// components -1 to 1: x along u, y along v (against it in the DirectX convention), z along the shading normal.
ACCURAY_NOINLINE inline Vec3 mapped_normal(const SceneView& scene, const MaterialRecord& material, Vec3 shading,
                                           TexturePoint p) {
  const TextureValue c = texture_value(scene, material.normal_map, p);
  turn_to_texture(scene, material.normal_map, p);
  const Frame frame = Frame::along(shading, p.dpdu);
  const float handed = dot(frame.y, p.dpdv) < 0.0f ? -1.0f : 1.0f;
  const float y = material.normal_map_down != 0 ? 1.0f - 2.0f * c[1] : 2.0f * c[1] - 1.0f;
  const float z = max(0.001f, 2.0f * c[2] - 1.0f);
  const Vec3 n = {material.normal_strength * (2.0f * c[0] - 1.0f), material.normal_strength * handed * y, z};
  const float squared = length_squared(n);
  return is_finite(squared) ? frame.to_world(n * (1.0f / sqrt(squared))) : shading;
}

// The shading normal nearest to the given one for which the viewer's mirror direction does not lie below the true
// surface; without it, normals that lean away from the viewer make black patches. The mirror direction is moved up to
// just above the horizon and the normal put half way between it and the viewer (after Keller et al. 2017, "The Iray
// Light Transport Simulation and Rendering System", who move it to the horizon: rounding then loses half of the
// reflections).
// Never inlined: flat surfaces go without it, and within the path it cost them 8 % of the time (Cornell box).
ACCURAY_NOINLINE inline Vec3 facing_normal(Vec3 normal, Vec3 shading, Vec3 wo) {
  const float cos_o = dot(normal, wo);
  const float side = cos_o < 0.0f ? -1.0f : 1.0f;
  const float twice = 2.0f * dot(shading, wo);
  const float above = fma(twice, dot(shading, normal), -cos_o);
  const float least = min(0.5f * abs(cos_o), 0.01f);
  if (above * side >= least) return shading;
  const Vec3 level = fma(-above, normal, fma(twice, shading, -wo));
  const Vec3 mirrored = fma(sqrt(1.0f - least * least) / length(level), level, normal * (side * least));
  const Vec3 bent = mirrored + wo;
  const float squared = length_squared(bent);
  return squared > 0.0f && is_finite(squared) ? bent * (side / sqrt(squared)) : normal;
}

}  // namespace accuray
