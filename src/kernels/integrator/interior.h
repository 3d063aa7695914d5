// The dielectrics that a path is inside of: what absorbs along the way, and which interfaces are real.
//
// A surface of a dielectric bounds its interior; going through it enters or leaves. Interiors may overlap, as a liquid
// that was modelled a little into its glass: of several at one place the one of highest priority fills it, of equals
// the one entered last (Schmidt and Budge 2002). An interface inside an interior of higher priority does not exist.
#pragma once

#include "kernels/math/functions.h"
#include "kernels/scene_view.h"

namespace accuray {

constexpr uint32_t most_interiors = 8;

// Indices into SceneView::interiors in the order of entering. Deeper nesting forgets the outermost.
struct Interiors {
  uint16_t count = 0;
  uint16_t entered[most_interiors] = {};

  void remove_at(uint32_t position) {
    for (uint32_t i = position; i + 1 < count; ++i) entered[i] = entered[i + 1];
    --count;
  }
  void enter(uint32_t interior) {
    if (count == most_interiors) remove_at(0);
    entered[count++] = static_cast<uint16_t>(interior);
  }
  // A body may be bounded by several materials, so one that was never entered ends what was entered last.
  void leave(uint32_t interior) {
    if (count == 0) return;
    uint32_t position = count - 1;
    while (position > 0 && entered[position] != interior) --position;
    remove_at(entered[position] == interior ? position : count - 1);
  }
  // What fills the place; none: vacuum.
  uint32_t filling(const SceneView& scene) const {
    uint32_t best = none;
    for (uint32_t i = 0; i < count; ++i) {
      if (best == none || scene.interiors[entered[i]].priority >= scene.interiors[best].priority) best = entered[i];
    }
    return best;
  }
};

// Whether the surface lies inside something of higher priority. Without a priority of its own it is always real.
inline bool is_hidden(const SceneView& scene, uint32_t interior, uint32_t exterior) {
  const uint32_t priority = scene.interiors[interior].priority;
  return priority != 0 && exterior != none && scene.interiors[exterior].priority > priority;
}

// Index of refraction before the surface: 1 where an index is relative to the surroundings, which is so without
// priorities on both sides.
inline Spectrum exterior_ior(const SceneView& scene, uint32_t interior, uint32_t exterior, const Wavelengths& wl) {
  if (exterior == none || scene.interiors[interior].priority == 0 || scene.interiors[exterior].priority == 0) {
    return lanes(1.0f);
  }
  return scene.spectrum(scene.interiors[exterior].ior, wl);
}

// What a body's surface lets through has its colour where that belongs to no depth.
inline bool is_tinted(const SceneView& scene, uint32_t interior) {
  return interior != none && scene.interiors[interior].per_depth == 0.0f &&
         scene.interiors[interior].color.index != none;
}

// Share of the light that an interior lets through over a distance: Beer 1852, with the colour that remains after a
// given depth in place of the coefficient.
inline Spectrum share_after(const SceneView& scene, uint32_t interior, float distance, const Wavelengths& wl) {
  if (interior == none || scene.interiors[interior].per_depth == 0.0f) return lanes(1.0f);
  const InteriorRecord& record = scene.interiors[interior];
  const double exponent = static_cast<double>(distance) * static_cast<double>(record.per_depth);
  Spectrum share = scene.spectrum(record.color, wl);
  for (int k = 0; k < 4; ++k) share[k] = static_cast<float>(pow(static_cast<double>(share[k]), exponent));
  return share;
}

}  // namespace accuray
