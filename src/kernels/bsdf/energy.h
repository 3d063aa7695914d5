// What facets that scatter light only once lose, and where it goes.
//
// A rough surface hides some of the light that one of its facets sends on behind another; a model that stops there
// darkens with roughness. The share lost from a direction is tabulated (tools/make_energy_table.py) for metals that
// absorb nothing and for the lossless interface of two dielectrics, and is given back in a lobe
//   f(wo, wi) = lost(wo) lost(wi) / (pi mean),    mean = the integral of 2 cos lost(wi) over cos,
// which is reciprocal and returns exactly what was lost (Kulla and Conty 2017). Through an interface it is divided
// among both sides such that the way back carries the same share.
#pragma once

#include "kernels/bsdf/energy_data.h"
#include "kernels/bsdf/microfacet.h"

namespace accuray {

// A place between two of a table's nodes, which lie evenly in [0, 1].
template <uint32_t nodes>
struct TablePlace {
  uint32_t first;
  float fraction;

  static TablePlace at(float t) {
    const float x = clamp(t, 0.0f, 1.0f) * static_cast<float>(nodes - 1);
    const uint32_t first = min(static_cast<uint32_t>(x), nodes - 2);
    return {first, x - static_cast<float>(first)};
  }
};

inline float between(float a, float b, float fraction) { return fma(fraction, b - a, a); }
template <uint32_t nodes>
inline float linear(const uint16_t (&row)[nodes], TablePlace<nodes> t) {
  return energy_step * between(row[t.first], row[t.first + 1], t.fraction);
}

// The table's coordinates of a roughness. Losses change at cosines of the size of alpha, so cosines are spread by it.
struct EnergyPlace {
  TablePlace<energy_roughnesses> rough;
  float reach;
  float strength;  // share of the loss that is given back

  // The table knows round facets. Stretched ones of the same mean slope lose more in some directions and less in
  // others, the less the narrower they are; what is given back stays below the least that any direction loses.
  static EnergyPlace of(float roughness, float anisotropy, bool compensate) {
    const float strength = compensate ? (1.0f - anisotropy) * (1.0f - 0.3f * anisotropy) : 0.0f;
    return {TablePlace<energy_roughnesses>::at(roughness),
            energy_reach * max(roughness * roughness, energy_least_alpha), strength};
  }
  float loss(const EnergyGrid& grid, float cosine) const {
    const auto place = TablePlace<energy_cosines>::at(sqrt(cosine * (1.0f + reach) / (cosine + reach)));
    return strength *
           between(linear(grid.value[rough.first], place), linear(grid.value[rough.first + 1], place), rough.fraction);
  }
  float mean(const EnergyRow& row) const { return strength * linear(row.value, rough); }
};

// A metal that reflects everything.
struct MetalLoss {
  EnergyPlace place;
  bool separable;

  float at(float cosine) const {
    return place.loss(separable ? energy_table.separable : energy_table.interface[energy_indices - 1][0], cosine);
  }
  float mean() const {
    return place.mean(separable ? energy_table.separable_mean : energy_table.mean[energy_indices - 1][0]);
  }
};

// The interface of two dielectrics, from either of its sides.
struct InterfaceLoss {
  EnergyPlace place;
  TablePlace<energy_indices> index;
  float share;  // of diffuse light passes, relative to the bare interface; 1 without a film

  static InterfaceLoss of(EnergyPlace place, float rare, float dense, float share) {
    return {place, TablePlace<energy_indices>::at(sqrt((dense - rare) / (dense + rare))), share};
  }
  float at(bool in_dense, float cosine) const {
    const uint32_t side = in_dense ? 1 : 0;
    const float bare = between(place.loss(energy_table.interface[index.first][side], cosine),
                               place.loss(energy_table.interface[index.first + 1][side], cosine), index.fraction);
    if (share != 1.0f) [[unlikely]]
      return with_film(MetalLoss{place, false}.at(cosine), bare);
    return bare;
  }
  float mean(bool in_dense) const {
    const uint32_t side = in_dense ? 1 : 0;
    const float bare = between(place.mean(energy_table.mean[index.first][side]),
                               place.mean(energy_table.mean[index.first + 1][side]), index.fraction);
    if (share != 1.0f) [[unlikely]]
      return with_film(MetalLoss{place, false}.mean(), bare);
    return bare;
  }
  // Share of what is given back that crosses the interface. From the rarer side it is what a smooth interface would let
  // through of diffuse light; from the denser one reciprocity leaves no choice.
  float crossing(bool in_dense, float rare, float dense) const {
    const float from_rare = min(share * linear(energy_table.transmitted, index), 1.0f);
    if (!in_dense) return from_rare;
    const float back = from_rare * mean(false) * rare * rare;
    return min(back / max(mean(true) * dense * dense, 0x1p-100f), 1.0f);
  }

 private:
  // Of the light that a film keeps from passing facets lose what a metal's do.
  float with_film(float reflecting, float bare) const { return max(between(reflecting, bare, share), 0.0f); }
};

}  // namespace accuray
