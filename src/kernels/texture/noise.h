// Solid noise: gradient noise in space (Perlin 2002, "Improving Noise"), with hashes in place of the permutation table.
#pragma once

#include "kernels/sampling/hash.h"
#include "kernels/texture/texture.h"

namespace accuray {

// A coordinate's lattice cell, and the position within it.
struct LatticeCell {
  uint32_t cell;
  float position;

  static LatticeCell of(float x) {
    const float low = floor(min(max(-1e9f, x), 1e9f));
    return {static_cast<uint32_t>(static_cast<int32_t>(low)), fraction_of(x)};
  }
};

// Dot product of (x, y, z) with one of the twelve directions to a cube's edges, four of them twice.
inline float lattice_gradient(uint32_t bits, float x, float y, float z) {
  const uint32_t h = bits & 15u;
  const float u = h < 8u ? x : y;
  const float v = h < 4u ? y : (h == 12u || h == 14u ? x : z);
  return ((h & 1u) != 0 ? -u : u) + ((h & 2u) != 0 ? -v : v);
}

inline float smooth_step5(float t) { return t * t * t * fma(t, fma(t, 6.0f, -15.0f), 10.0f); }

// Between -1 and 1, 0 at the points of the lattice; `seed` chooses another field.
inline float gradient_noise(Vec3 p, uint32_t seed) {
  const LatticeCell x = LatticeCell::of(p.x);
  const LatticeCell y = LatticeCell::of(p.y);
  const LatticeCell z = LatticeCell::of(p.z);
  const float sx = smooth_step5(x.position);
  const float sy = smooth_step5(y.position);
  const float sz = smooth_step5(z.position);
  float plane[2];
  for (uint32_t k = 0; k < 2; ++k) {
    float line[2];
    for (uint32_t j = 0; j < 2; ++j) {
      const float dy = y.position - static_cast<float>(j);
      const float dz = z.position - static_cast<float>(k);
      const float a = lattice_gradient(hash(seed, x.cell, y.cell + j, z.cell + k), x.position, dy, dz);
      const float b = lattice_gradient(hash(seed, x.cell + 1, y.cell + j, z.cell + k), x.position - 1.0f, dy, dz);
      line[j] = fma(sx, b - a, a);
    }
    plane[k] = fma(sy, line[1] - line[0], line[0]);
  }
  return fma(sz, plane[1] - plane[0], plane[0]);
}

// Octaves of noise, each twice as fine and `gain` times as strong as the one before (Musgrave 1993), divided by the sum
// of their strengths: between -1 and 1.
inline float octave_noise(Vec3 p, uint32_t octaves, float gain) {
  float total = 0.0f;
  float strength = 1.0f;
  float sum = 0.0f;
  for (uint32_t i = 0; i < octaves; ++i) {
    total = fma(strength, gradient_noise(p, i), total);
    sum += strength;
    strength *= gain;
    p = p * 2.0f;
  }
  return total / sum;
}

// Parameters that all textures made of noise share.
constexpr Param size_param(const char* doc, uint32_t member) {
  return {.name = "size",
          .kind = Kind::real,
          .doc = doc,
          .preset = "1",
          .low = 1e-12,
          .unit = "m",
          .animatable = true,
          .member = member};
}
constexpr Param octaves_param(const char* preset, uint32_t member) {
  return {.name = "octaves",
          .kind = Kind::integer,
          .doc = "Layers of noise, each twice as fine and half as strong as the one before.",
          .preset = preset,
          .low = 1,
          .high = 16,
          .member = member};
}

struct NoiseTexture {
  Vec3 first, second;
  float size;
  int32_t octaves;

  static constexpr const char* name = "noise";
  static constexpr const char* doc = "A mixture of two colours that varies at random in space, like clouds.";
  static constexpr bool reads_uv = false;
  static constexpr auto params() {
    return param_list(colour_param("first", "Colour where the noise is low, linear Rec.709.", "[0, 0, 0]",
                                   ACCURAY_OFFSET_OF(NoiseTexture, first)),
                      colour_param("second", "Colour where it is high, linear Rec.709.", "[1, 1, 1]",
                                   ACCURAY_OFFSET_OF(NoiseTexture, second)),
                      size_param("Width of the largest features.", ACCURAY_OFFSET_OF(NoiseTexture, size)),
                      octaves_param("4", ACCURAY_OFFSET_OF(NoiseTexture, octaves)));
  }
  float step() const { return 0x1p-8f * size; }
  TextureValue value(const SceneView&, const TexturePoint& p) const {
    const float n = octave_noise(p.point * (1.0f / size), static_cast<uint32_t>(octaves), 0.5f);
    return mixed(first, second, fma(0.5f, n, 0.5f));
  }
};

}  // namespace accuray
