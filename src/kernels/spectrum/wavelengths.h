// The wavelengths that one path carries, and spectra evaluated at them.
//
// Conventions
//   - Wavelengths are in nanometres within [360, 830]; tables hold values at 360, 361, ... 830.
//   - A path carries four (Wilkie et al. 2014, "Hero Wavelength Spectral Sampling"). `weight` is 1/(4 pdf) per lane, so
//     that the sum over lanes of value * weight estimates the integral over wavelength.
//   - After a dispersing interface only lane 0, the hero, goes on: see keep_hero.
#pragma once

#include "kernels/port.h"

namespace accuray {

using Spectrum = f32x4;

constexpr float lambda_min = 360.0f;
constexpr float lambda_max = 830.0f;
constexpr uint32_t lambda_cells = 470;
constexpr uint32_t lambda_nodes = 471;

struct Wavelengths {
  f32x4 lambda;    // nm
  f32x4 weight;    // 1 / (4 pdf), nm
  bool hero_only;  // lanes 1 to 3 carry nothing any more

  static Wavelengths at(f32x4 lambda, f32x4 weight) { return {lambda, weight, false}; }

  struct Cells {
    u32x4 index;     // of the 1 nm cell
    f32x4 fraction;  // position within the cell
  };
  Cells cells() const {
    const f32x4 t = min(max(lambda - lambda_min, lanes(0.0f)), lanes(static_cast<float>(lambda_cells) - 0x1p-14f));
    const u32x4 index = to_index(t);
    return {index, t - to_float(index)};
  }
};

inline float sum(f32x4 a) { return (a[0] + a[1]) + (a[2] + a[3]); }
inline float max_lane(f32x4 a) { return max(max(a[0], a[1]), max(a[2], a[3])); }
inline bool is_black(f32x4 a) { return a[0] == 0.0f && a[1] == 0.0f && a[2] == 0.0f && a[3] == 0.0f; }

// Throughput of a path that goes on with its hero alone: any one lane is an estimate by itself, at a quarter of the
// weight that it has among four.
inline Spectrum keep_hero(Spectrum throughput) { return lanes(4.0f * throughput[0], 0.0f, 0.0f, 0.0f); }

// A table with values at every nanometre, linear in between.
inline Spectrum lookup(const float* table, const Wavelengths& wl) {
  const Wavelengths::Cells at = wl.cells();
  const float* t0 = table + at.index[0];
  const float* t1 = table + at.index[1];
  const float* t2 = table + at.index[2];
  const float* t3 = table + at.index[3];
  const f32x4 a = lanes(t0[0], t1[0], t2[0], t3[0]);
  const f32x4 b = lanes(t0[1], t1[1], t2[1], t3[1]);
  return fma(at.fraction, b - a, a);
}

}  // namespace accuray
