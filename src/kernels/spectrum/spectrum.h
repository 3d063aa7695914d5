// Spectra as the scene stores them. The lowering chooses the form; a parameter holds a SpectrumRef.
#pragma once

#include "kernels/spectrum/wavelengths.h"

namespace accuray {

enum class SpectrumForm : uint32_t {
  constant,     // scale
  table,        // scale * table at 1 nm
  fine,         // scale * table with a step of its own
  sigmoid,      // scale * S(c0 t^2 + c1 t + c2), t = (lambda - 360) / 470 (Jakob and Hanika 2019)
  lit_sigmoid,  // the same times a table at 1 nm: an RGB light under a white
  // From here on the spectrum differs from point to point: read by textured_spectrum() in texture/list.h.
  textured,           // scale * the texture number `table`, as a reflectance
  textured_index,     // scale * channel `count` of the texture number `table`, within c0 and c1, at all wavelengths
  textured_emission,  // scale * the texture number `count` under the table's white; here: of the texture's white
  directional         // what its light says for a direction; here: scale * table at 1 nm, the mean over directions
};

constexpr bool is_textured(SpectrumForm form) { return form >= SpectrumForm::textured; }

struct SpectrumRecord {
  SpectrumForm form;
  float scale;
  float c0, c1, c2;
  uint32_t table;  // index of the table's first value in the scene's tables
  uint32_t count;  // number of values (fine)
  float step;      // nm between values (fine)
};

struct SpectrumRef {
  uint32_t index;
};

// S(x) = 1/2 + x / (2 sqrt(1 + x^2)), Jakob and Hanika 2019, eq. 4. For x < 0 that form cancels, so both signs go
// through the small tail 1 / (2 s (s + |x|)), s = sqrt(1 + x^2).
inline f32x4 sigmoid(f32x4 x) {
  const f32x4 s = sqrt(fma(x, x, lanes(1.0f)));
  f32x4 value = 0.5f / (s * (s + max(x, 0.0f - x)));
  for (int k = 0; k < 4; ++k) {
    if (x[k] >= 0.0f) value[k] = 1.0f - value[k];
  }
  return value;
}

inline f32x4 sigmoid_of(const SpectrumRecord& s, const Wavelengths& wl) {
  const f32x4 t = (wl.lambda - lambda_min) * (1.0f / 470.0f);
  return sigmoid(fma(fma(lanes(s.c0), t, lanes(s.c1)), t, lanes(s.c2)));
}

inline f32x4 lookup_fine(const SpectrumRecord& s, const float* table, const Wavelengths& wl) {
  const f32x4 last = lanes(static_cast<float>(s.count - 1u));
  const f32x4 t = min(max((wl.lambda - lambda_min) * (1.0f / s.step), lanes(0.0f)), last);
  const u32x4 cell = to_index(min(t, last - 1.0f));
  const f32x4 a = lanes(table[cell[0]], table[cell[1]], table[cell[2]], table[cell[3]]);
  const f32x4 b = lanes(table[cell[0] + 1], table[cell[1] + 1], table[cell[2] + 1], table[cell[3] + 1]);
  return fma(t - to_float(cell), b - a, a);
}

// Values of a spectrum at the path's wavelengths; `tables` is the scene's pool of table values.
inline Spectrum evaluate(const SpectrumRecord& s, const float* tables, const Wavelengths& wl) {
  switch (s.form) {
    case SpectrumForm::table:
    case SpectrumForm::textured_emission:
    case SpectrumForm::directional:
      return lookup(tables + s.table, wl) * s.scale;
    case SpectrumForm::fine:
      return lookup_fine(s, tables + s.table, wl) * s.scale;
    case SpectrumForm::sigmoid:
      return sigmoid_of(s, wl) * s.scale;
    case SpectrumForm::lit_sigmoid:
      return sigmoid_of(s, wl) * lookup(tables + s.table, wl) * s.scale;
    case SpectrumForm::textured:
    case SpectrumForm::textured_index:
    case SpectrumForm::constant:
      break;
  }
  return lanes(s.scale);
}

}  // namespace accuray
