// The eleven bands of the spectral sky and sun of Hosek and Wilkie (2012, 2013): 320, 360, ... 720 nm, linear in
// between.
#pragma once

#include "kernels/spectrum/wavelengths.h"

namespace accuray {

constexpr uint32_t sky_bands = 11;
constexpr float first_band = 320.0f;  // nm
constexpr float band_step = 40.0f;

// Values at the path's wavelengths of what band(i) gives. Departure: beyond the last band its value holds, where the
// model stops.
template <class Band>
inline Spectrum between_bands(const Wavelengths& wl, const Band& band) {
  Spectrum result = lanes(0.0f);
  for (int k = 0; k < 4; ++k) {
    const float x = clamp((wl.lambda[k] - first_band) / band_step, 0.0f, static_cast<float>(sky_bands - 1));
    const uint32_t below = min(static_cast<uint32_t>(x), sky_bands - 2u);
    const float low = band(below);
    result[k] = fma(x - static_cast<float>(below), band(below + 1u) - low, low);
  }
  return result;
}

}  // namespace accuray
