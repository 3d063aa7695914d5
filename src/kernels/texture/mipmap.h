// Mipmaps: a picture at half its size, at half of that, and so on to a single texel (Williams 1983), and the level at
// which a texel is as large as what a ray stands for (Akenine-Moller et al. 2021).
//
// Level 0 is the picture itself. Of a picture of w x h texels level k has max(1, w >> k) x max(1, h >> k), each the
// mean in linear light of the part of the level before that it covers, so the mean of a picture is that of all its
// levels.
#pragma once

#include "kernels/math/functions.h"
#include "kernels/texture/texels.h"

namespace accuray {

// Levels 1 to `count`, one after the other, row by row from the top, channels next to each other, as linear numbers.
struct Mipmaps {
  Slice<float> texels;
  uint32_t count;
};

struct MipLevel {
  const float* texels;
  uint32_t width, height;

  TextureValue texel(int32_t x, int32_t y, uint32_t channels) const {
    if (x < 0 || y < 0) return lanes(0.0f);
    const float* t = texels + (static_cast<size_t>(y) * width + static_cast<size_t>(x)) * channels;
    if (channels < 3) return lanes(t[0], t[0], t[0], channels == 2 ? t[1] : 1.0f);
    return lanes(t[0], t[1], t[2], channels == 4 ? t[3] : 1.0f);
  }
};

constexpr uint32_t mip_size(uint32_t size, uint32_t level) { return max(1u, size >> level); }

// Level 1 or above.
inline MipLevel mip_at(const SceneView& scene, const Mipmaps& mipmaps, uint32_t width, uint32_t height,
                       uint32_t channels, uint32_t level) {
  const float* texels = scene.at(mipmaps.texels);
  for (uint32_t k = 1; k < level; ++k) {
    texels += static_cast<size_t>(mip_size(width, k)) * mip_size(height, k) * channels;
  }
  return {texels, mip_size(width, level), mip_size(height, level)};
}

// log2 of the footprint in texels, whose number per square metre follows from the derivatives of the point by the
// texture coordinates; from 0 to the last level.
inline float mip_level(const TexturePoint& p, const UvMap& map, uint32_t width, uint32_t height, uint32_t last) {
  const float by_map = abs(difference_of_products(map.m[0][0], map.m[1][1], map.m[0][1], map.m[1][0]));
  const float texels = by_map * static_cast<float>(width) * static_cast<float>(height);
  const double covered = static_cast<double>(p.footprint) * static_cast<double>(p.footprint) *
                         static_cast<double>(texels) / static_cast<double>(length(cross(p.dpdu, p.dpdv)));
  if (!(covered > 1.0)) return 0.0f;
  constexpr double half_per_ln2 = 0.72134752044448170;
  return min(static_cast<float>(half_per_ln2 * log(min(covered, 1e30))), static_cast<float>(last));
}

}  // namespace accuray
