// Owen-scrambled Sobol points in padded sets of four dimensions (Burley 2020, "Practical Hash-based Owen Scrambling").
//
// Within a set the four coordinates form the first four dimensions of Sobol's sequence with the direction numbers of
// Joe and Kuo 2008. Sets are made independent by shuffling the index (an Owen scramble of the index itself) and by
// fresh scrambles of the coordinates. Departures from the paper:
//   - The hash is Vegdahl's 2021 refinement of the Laine-Karras permutation, whose low bits mix better.
//   - Tables hold bit-reversed Sobol numbers, because that is the order in which the scramble works.
//   - The index is shuffled within aligned blocks of 2^16, which keeps every prefix a net and needs two table
//     look-ups instead of four; beyond 2^16 samples the upper bits come from the direction numbers one by one.
#pragma once

#include "kernels/sampling/hash.h"

namespace accuray {

struct SobolTable {
  uint32_t low[256][4];   // bit-reversed points of indices 0..255
  uint32_t high[256][4];  // of indices 0..255 times 256
  uint32_t bit[32][4];    // of single bits
};

constexpr uint32_t reverse_bits_slow(uint32_t x) {
  uint32_t y = 0;
  for (int i = 0; i < 32; ++i) y |= ((x >> i) & 1u) << (31 - i);
  return y;
}

constexpr SobolTable make_sobol_table() {
  // Primitive polynomials (degree, inner coefficients) and initial numbers of dimensions 2 to 4 (Joe and Kuo 2008).
  constexpr uint32_t degree[4] = {0, 1, 2, 3};
  constexpr uint32_t inner[4] = {0, 0, 1, 1};
  constexpr uint32_t start[4][3] = {{1, 1, 1}, {1, 0, 0}, {1, 3, 0}, {1, 3, 1}};
  SobolTable table{};
  for (uint32_t d = 0; d < 4; ++d) {
    uint32_t v[32]{};
    for (uint32_t i = 0; i < 32; ++i) {
      if (d == 0) {
        v[i] = 1u << (31 - i);
      } else if (i < degree[d]) {
        v[i] = start[d][i] << (31 - i);
      } else {
        v[i] = v[i - degree[d]] ^ (v[i - degree[d]] >> degree[d]);
        for (uint32_t k = 1; k < degree[d]; ++k) {
          if (((inner[d] >> (degree[d] - 1 - k)) & 1u) != 0) v[i] ^= v[i - k];
        }
      }
      table.bit[i][d] = reverse_bits_slow(v[i]);
    }
    for (uint32_t n = 0; n < 256; ++n) {
      for (uint32_t b = 0; b < 8; ++b) {
        if (((n >> b) & 1u) == 0) continue;
        table.low[n][d] ^= table.bit[b][d];
        table.high[n][d] ^= table.bit[b + 8][d];
      }
    }
  }
  return table;
}

inline constexpr SobolTable sobol_table = make_sobol_table();

// Laine-Karras permutation, Vegdahl's constants: each bit depends on itself, the seed and the bits below.
inline uint32_t scramble(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}
inline u32x4 scramble(u32x4 x, u32x4 seed) {
  x ^= x * 0x3d20adeau;
  x = x + seed;
  x *= (seed >> 16u) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

inline u32x4 load_point(const uint32_t (&row)[4]) { return lanes_u(row[0], row[1], row[2], row[3]); }

// One sample's source of numbers: point `index` of the scrambled sequences chosen by `key`.
struct Sampler {
  uint32_t key;       // identifies (seed, pixel, replicate)
  uint32_t index;     // number of the sample within its replicate
  uint32_t reversed;  // the lower 16 bits of index, reversed

  static Sampler at(uint32_t key, uint32_t index) { return {key, index, reverse_bits(index << 16)}; }

  // Four coordinates in [0, 1) of padded set number `set`.
  f32x4 draw(uint32_t set) const {
    const uint32_t seed = hash(key + set * 0x9e3779b9u);
    const uint32_t block = index >> 16;
    const uint32_t shuffled = reverse_bits(scramble(reversed, hash(seed ^ block))) >> 16;
    u32x4 x = load_point(sobol_table.low[shuffled & 255u]) ^ load_point(sobol_table.high[shuffled >> 8]);
    for (uint32_t b = 0; (block >> b) != 0; ++b) {
      if (((block >> b) & 1u) != 0) x ^= load_point(sobol_table.bit[b + 16]);
    }
    const u32x4 seeds = hash(lanes_u(seed) + lanes_u(0x2c1b3c6du, 0x297a2d39u, 0x5851f42du, 0x6a09e667u));
    return uniform(reverse_bits(scramble(x, seeds)));
  }
};

}  // namespace accuray
