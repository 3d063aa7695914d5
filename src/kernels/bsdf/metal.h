// The reflectance of a metal's facet: from its complex index, with a film on it or without, or from two colours.
#pragma once

#include "kernels/bsdf/bsdf.h"
#include "kernels/bsdf/fresnel.h"
#include "kernels/bsdf/thin_film.h"

namespace accuray {

struct MetalAt {
  Spectrum a, b;  // real and imaginary part of the index; or reflectance along the normal and depth of the dip
  FilmAt film = {};
  bool tinted = false;

  static MetalAt of_index(Spectrum eta, Spectrum k, FilmAt film = {}) { return {eta, k, film}; }
  // Schlick's curve with a dip that gives reflectance times tint at 82 degrees, where the curves of metals are lowest
  // (Kutz, Hasan and Edmondson 2021).
  static MetalAt of_colours(Spectrum reflectance, Spectrum tint) {
    constexpr float c = 1.0f / 7.0f;
    constexpr float rest = (1.0f - c) * (1.0f - c) * (1.0f - c) * (1.0f - c) * (1.0f - c);
    const Spectrum at_82 = reflectance + (1.0f - reflectance) * rest;
    return {reflectance, at_82 * (1.0f - tint) * (1.0f / (c * rest * (1.0f - c))), {}, true};
  }

  // A film needs an index: the one that gives this reflectance along the normal, and towards the edge the curve of the
  // most metallic index that does where the tint is 1, of the least metallic where it is 0 (Gulbrandsen 2014).
  ACCURAY_NOINLINE static MetalAt of_filmed_colours(Spectrum reflectance, Spectrum tint, FilmAt film) {
    const Spectrum r = min(reflectance, lanes(brightest));
    const Spectrum root = sqrt(r);
    const Spectrum least = (1.0f - r) / (1.0f + r);
    const Spectrum most = (1.0f + root) / (1.0f - root);
    const Spectrum n = most + tint * (least - most);
    const Spectrum k2 = (r * (n + 1.0f) * (n + 1.0f) - (n - 1.0f) * (n - 1.0f)) / (1.0f - r);
    return of_index(n, sqrt(max(k2, lanes(0.0f))), film);
  }
  static constexpr float brightest = 0.9999f;

  Spectrum reflectance(float cosine) const {
    if (film.exists()) [[unlikely]]
      return film_on_metal(film, a, b, cosine);
    if (!tinted) return fresnel_conductor(cosine, a, b);
    const float x = 1.0f - cosine;
    const float x5 = x * x * x * x * x;
    return min(max(a + (1.0f - a) * x5 - b * (cosine * x5 * x), lanes(0.0f)), lanes(1.0f));
  }
  // Of diffuse light: the integral of 2 cos F, in closed form, or by Gauss and Jacobi's rule of three nodes
  // (Abramowitz and Stegun 1964, table 25.8).
  Spectrum mean() const {
    if (tinted) return a * (20.0f / 21.0f) + (1.0f / 21.0f) - b * (1.0f / 126.0f);
    return reflectance(0.2123405382f) * 0.1396539598f + reflectance(0.5905331356f) * 0.4584822128f +
           reflectance(0.9114120405f) * 0.4018638274f;
  }
};

}  // namespace accuray
