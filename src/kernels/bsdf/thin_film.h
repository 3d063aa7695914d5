// A thin layer on an interface: light reflected at its two faces interferes.
//
// Exact for a plane homogeneous film and light of one wavelength: the sum over all reflections inside it, by its
// characteristic matrix, for s and p light apart, then their mean (Airy 1833; Born and Wolf 1999, sections 1.6 and
// 7.6). The path's lanes are single wavelengths, so colours need no further approximation.
//
// Conventions
//   - Indices and cosines count from the medium before the surface, whose index is 1 here; wavelengths are those there.
//   - w = n cos(theta) is the part of the wave's vector along the normal; w^2 of the film is real and below 0 where the
//     film reflects totally and light leaks through. c = cos(pi turns w), s = sin(pi turns w) / w, up to a common
//     sign.
//   - Phases are computed in double: a film is up to some hundred wavelengths thick.
#pragma once

#include "kernels/bsdf/bsdf.h"
#include "kernels/bsdf/fresnel.h"
#include "kernels/math/functions.h"

namespace accuray {

// The film at a hit.
struct FilmAt {
  Spectrum index = lanes(1.0f);
  Spectrum turns = lanes(0.0f);  // twice the thickness over the wavelength; 0: there is none

  bool exists() const { return turns[0] > 0.0f; }
  static FilmAt of(const ShadingPoint& p, const RealRef& thickness, SpectrumRef ior) {
    const float metres = p.real(thickness);
    if (!(metres > 0.0f)) [[likely]]
      return {};
    return {p.spectrum(ior) / p.exterior, 2.0f * min(metres * 1e9f, thickest) / p.wl.lambda * p.exterior};
  }
  static constexpr float thickest = 1e5f;  // what film_params() allows, for textures
};

struct FilmPhase {
  float w2, c, s;  // w2 = w^2 of the film
};

inline double sine_squared(float cosine) {
  const double c = static_cast<double>(cosine);
  return 1.0 - c * c;
}

// For the square of the sine before the surface.
inline FilmPhase film_phase(const FilmAt& film, int k, double sin2) {
  const double n = static_cast<double>(film.index[k]);
  const double w2 = n * n - sin2;
  const double w = sqrt(abs(w2));
  const double turns = static_cast<double>(film.turns[k]);
  const float narrow = static_cast<float>(w2);
  if (w * turns < 1e-6) return {narrow, 1.0f, pi * static_cast<float>(turns)};
  if (w2 > 0.0) {
    const double x = w * turns;
    const SinCos wave = sincos(pi * static_cast<float>(x - floor(x + 0.5)));
    return {narrow, wave.cos, wave.sin / static_cast<float>(w)};
  }
  constexpr double opaque = 30.0;
  const double grown = exp(min(w * turns * static_cast<double>(pi), opaque));
  return {narrow, static_cast<float>(0.5 * (grown + 1.0 / grown)), static_cast<float>(0.5 * (grown - 1.0 / grown) / w)};
}

// Share that a film between transparent media lets through; `before` and `behind` are w on its two sides. It is the
// same from both, to the bit, and what is left is reflected.
inline float lossless_transmittance(const FilmAt& film, int k, float ior, double sin2, float before, float behind) {
  const FilmPhase phase = film_phase(film, k, sin2);
  const float through = 4.0f * before * behind;
  const float both = before * behind;
  const float n2 = ior * ior;
  const float f2 = film.index[k] * film.index[k];
  const float s0 = (before + behind) * phase.c;
  const float s1 = (both + phase.w2) * phase.s;
  const float p0 = fma(n2, before, behind) * phase.c;
  const float p1 = fma(f2, both, n2 / f2 * phase.w2) * phase.s;
  constexpr float tiny = 0x1p-100f;
  return 0.5f * through * (1.0f / max(fma(s0, s0, s1 * s1), tiny) + n2 / max(fma(p0, p0, p1 * p1), tiny));
}

// Of an interface with the index `ior` behind it, for light that comes at `cosine` from before it (above) or from
// behind; 1 on total reflection.
ACCURAY_NOINLINE inline Spectrum film_reflectance(FilmAt film, Spectrum ior, float cosine, bool above) {
  Spectrum result = lanes(1.0f);
  for (int k = 0; k < 4; ++k) {
    const double n2 = static_cast<double>(ior[k]) * static_cast<double>(ior[k]);
    const double sin2 = above ? sine_squared(cosine) : n2 * sine_squared(cosine);
    const double other2 = above ? n2 - sin2 : 1.0 - sin2;
    if (other2 <= 0.0) continue;
    const float other = static_cast<float>(sqrt(other2));
    const float own = above ? cosine : ior[k] * cosine;
    const float through = lossless_transmittance(film, k, ior[k], sin2, above ? own : other, above ? other : own);
    result[k] = max(1.0f - through, 0.0f);
  }
  return result;
}

// What passes one lane's interface, by the cosines on both sides.
ACCURAY_NOINLINE inline float film_transmittance(FilmAt film, int k, float ior, float before, float behind) {
  return lossless_transmittance(film, k, ior, sine_squared(before), before, ior * behind);
}

// Transmittance for diffuse light over that of the bare interface, from the rarer side: both are means over the square
// of the cosine.
ACCURAY_NOINLINE inline Spectrum film_on_diffuse_light(FilmAt film, Spectrum ior) {
  constexpr int nodes = 8;
  const bool above = ior[0] >= 1.0f;
  const Spectrum beyond = above ? ior : 1.0f / ior;
  Spectrum with = lanes(0.0f);
  Spectrum without = lanes(0.0f);
  for (int i = 0; i < nodes; ++i) {
    const float cosine = sqrt((static_cast<float>(i) + 0.5f) / static_cast<float>(nodes));
    with += 1.0f - film_reflectance(film, ior, cosine, above);
    without += 1.0f - fresnel_dielectric(cosine, beyond);
  }
  return with / without;
}

struct Complex {
  float re, im;
};
inline Complex operator+(Complex a, Complex b) { return {a.re + b.re, a.im + b.im}; }
inline Complex operator-(Complex a, Complex b) { return {a.re - b.re, a.im - b.im}; }
inline Complex operator*(float a, Complex b) { return {a * b.re, a * b.im}; }
inline Complex operator*(Complex a, Complex b) {
  return {difference_of_products(a.re, b.re, a.im, b.im), fma(a.re, b.im, a.im * b.re)};
}
inline Complex minus_i(Complex a) { return {a.im, -a.re}; }
inline float squared(Complex a) { return fma(a.re, a.re, a.im * a.im); }
inline float ratio(Complex a, Complex b) { return squared(a) / max(squared(b), 0x1p-100f); }
// The root in the first quadrant; a.im >= 0.
inline Complex root(Complex a) {
  const float modulus = sqrt(squared(a));
  const float re = sqrt(max(0.5f * (modulus + a.re), 0.0f));
  const float im = sqrt(max(0.5f * (modulus - a.re), 0.0f));
  return a.re > 0.0f ? Complex{re, 0.5f * a.im / max(re, 0x1p-100f)} : Complex{0.5f * a.im / max(im, 0x1p-100f), im};
}

// On a metal of index eta + i k, for waves exp(-i omega t).
ACCURAY_NOINLINE inline Spectrum film_on_metal(FilmAt film, Spectrum eta, Spectrum k, float cosine) {
  Spectrum result = lanes(0.0f);
  const double sin2 = sine_squared(cosine);
  for (int lane = 0; lane < 4; ++lane) {
    const FilmPhase phase = film_phase(film, lane, sin2);
    const float f2 = film.index[lane] * film.index[lane];
    const Complex n2 = {(eta[lane] - k[lane]) * (eta[lane] + k[lane]), 2.0f * eta[lane] * k[lane]};
    const Complex w = root({n2.re - static_cast<float>(sin2), n2.im});
    // The fields before the film, electric and magnetic, that give the ones inside the metal.
    const Complex se = Complex{phase.c, 0.0f} + phase.s * minus_i(w);
    const Complex sm = phase.c * w + (phase.s * phase.w2) * minus_i({1.0f, 0.0f});
    const Complex pe = phase.c * w + (phase.s * phase.w2 / f2) * minus_i(n2);
    const Complex pm = phase.c * n2 + (phase.s * f2) * minus_i(w);
    const float s = ratio(cosine * se - sm, cosine * se + sm);
    const float p = ratio(pe - cosine * pm, pe + cosine * pm);
    result[lane] = min(0.5f * (s + p), 1.0f);
  }
  return result;
}

constexpr ParamList<2> film_params(uint32_t thickness, uint32_t ior) {
  return param_list(
      Param{.name = "film_thickness",
            .kind = Kind::real,
            .doc =
                "Thickness of a transparent film on the surface, whose two faces' reflections interfere; 0: no film. "
                "A texture's value is multiplied by its scale, in nm.",
            .preset = "0",
            .low = 0,
            .high = static_cast<double>(FilmAt::thickest),
            .unit = "nm",
            .texturable = true,
            .animatable = true,
            .member = thickness},
      index_param("film_ior", "Index of the film, counted as the surface's own index is.", "1.33", ior));
}

}  // namespace accuray
