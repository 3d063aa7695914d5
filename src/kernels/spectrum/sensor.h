// What looks at the light: which wavelengths a sample carries and what four numbers it adds to the film.
#pragma once

#include "kernels/scene_view.h"

namespace accuray {

// colour: wavelengths sampled by sensor times emission, channels X, Y, Z and alpha.
// fixed: the four given wavelengths, a channel each. A path's hero changes from sample to sample, so that each
// wavelength is right behind dispersing glass too.
struct Observer {
  uint32_t fixed;
  f32x4 lambda;
};

// Inverts the running sums of the cells' probabilities; the guide gives the first cell that u can be in.
inline float lambda_from_cdf(const SceneView& scene, float u, float& pdf) {
  const float* cdf = scene.lambda_cdf;
  uint32_t cell = scene.lambda_guide[static_cast<uint32_t>(u * static_cast<float>(lambda_guide_size))];
  while (cell + 1 < lambda_cells && cdf[cell + 1] <= u) ++cell;
  pdf = cdf[cell + 1] - cdf[cell];
  return lambda_min + static_cast<float>(cell) + clamp((u - cdf[cell]) / pdf, 0.0f, one_minus_epsilon);
}

// Position of the hero among the fixed wavelengths.
inline uint32_t hero_of(const Observer& observer, float u) {
  return observer.fixed != 0 ? min(static_cast<uint32_t>(u * 4.0f), 3u) : 0u;
}

// u in [0, 1) is rotated by quarters to give the four lanes; each lane alone has the sensor's density.
inline Wavelengths sample_wavelengths(const SceneView& scene, const Observer& observer, float u) {
  if (observer.fixed != 0) {
    const uint32_t hero = hero_of(observer, u);
    const f32x4 l = observer.lambda;
    return Wavelengths::at(lanes(l[hero], l[(hero + 1) & 3], l[(hero + 2) & 3], l[(hero + 3) & 3]), lanes(1.0f));
  }
  f32x4 lambda = lanes(0.0f);
  f32x4 weight = lanes(0.0f);
  for (int k = 0; k < 4; ++k) {
    float shifted = u + 0.25f * static_cast<float>(k);
    if (shifted >= 1.0f) shifted -= 1.0f;
    float pdf = 0.0f;
    lambda[k] = lambda_from_cdf(scene, shifted, pdf);
    weight[k] = 0.25f / pdf;
  }
  return Wavelengths::at(lambda, weight);
}

// The film's channels for a radiance and a coverage.
inline f32x4 respond(const SceneView& scene, const Observer& observer, const Wavelengths& wl, Spectrum radiance,
                     float alpha, float u_lambda) {
  const f32x4 value = radiance * wl.weight;
  if (observer.fixed != 0) {
    const uint32_t hero = hero_of(observer, u_lambda);
    return lanes(value[(4 - hero) & 3], value[(5 - hero) & 3], value[(6 - hero) & 3], value[(7 - hero) & 3]);
  }
  f32x4 channels = lanes(0.0f);
  const Wavelengths::Cells at = wl.cells();
  for (int k = 0; k < 4; ++k) {
    const float* node = scene.response + size_t{4} * at.index[k];
    const f32x4 a = lanes(node[0], node[1], node[2], node[3]);
    const f32x4 b = lanes(node[4], node[5], node[6], node[7]);
    channels = fma(fma(lanes(at.fraction[k]), b - a, a), lanes(value[k]), channels);
  }
  channels[3] = alpha;
  return channels;
}

}  // namespace accuray
