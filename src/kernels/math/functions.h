// Elementary functions of our own, so that a sample has the same bits with every libm and on every device of one
// kind: only +, -, *, /, sqrt, fma and bit operations are used. Single precision errors are a few units in the last
// place (functions_test.cpp states them); the double versions serve the tables made while lowering.
#pragma once

#include "kernels/math/constants.h"
#include "kernels/port.h"

namespace accuray {

// Sine and cosine of x in [-pi/4, pi/4]: minimax polynomials (coefficients as in Cephes sinf, cosf; Moshier 1989).
inline float sin_quadrant(float x) {
  const float z = x * x;
  const float p = fma(fma(-1.9515295891e-4f, z, 8.3321608736e-3f), z, -1.6666654611e-1f);
  return fma(p * z, x, x);
}
inline float cos_quadrant(float x) {
  const float z = x * x;
  const float p = fma(fma(2.443315711809948e-5f, z, -1.388731625493765e-3f), z, 4.166664568298827e-2f);
  return fma(p * z, z, fma(-0.5f, z, 1.0f));
}

struct SinCos {
  float sin, cos;
};

// Sine and cosine for |x| up to some thousands: the quadrant is removed with pi/2 split in three parts (Cody and
// Waite 1980).
inline SinCos sincos(float x) {
  const float k = floor(fma(x, 0.63661977236758134f, 0.5f));
  float r = fma(k, -1.5703125f, x);
  r = fma(k, -4.837512969970703125e-4f, r);
  r = fma(k, -7.5497899548918821e-8f, r);
  const int32_t quadrant = static_cast<int32_t>(k) & 3;
  const float s = sin_quadrant(r);
  const float c = cos_quadrant(r);
  const float sine = (quadrant & 1) != 0 ? c : s;
  const float cosine = (quadrant & 1) != 0 ? s : c;
  return {(quadrant & 2) != 0 ? -sine : sine, ((quadrant + 1) & 2) != 0 ? -cosine : cosine};
}

// Arc tangent of x in [-1, 1]-reduced form, odd polynomial (Cephes atanf).
inline float atan(float x) {
  const float a = abs(x);
  float base = 0.0f;
  float t = a;
  if (a > 2.414213562373095f) {
    base = half_pi;
    t = -1.0f / a;
  } else if (a > 0.4142135623730950f) {
    base = quarter_pi;
    t = (a - 1.0f) / (a + 1.0f);
  }
  const float z = t * t;
  const float p = fma(fma(fma(8.05374449538e-2f, z, -1.38776856032e-1f), z, 1.99777106478e-1f), z, -3.33329491539e-1f);
  const float result = base + fma(p * z, t, t);
  return x < 0.0f ? -result : result;
}

// Angle of the point (x, y), in (-pi, pi].
inline float atan2(float y, float x) {
  if (x == 0.0f && y == 0.0f) return 0.0f;
  if (abs(x) >= abs(y)) {
    const float angle = atan(y / x);
    return x > 0.0f ? angle : (y < 0.0f ? angle - pi : angle + pi);
  }
  const float angle = atan(x / y);
  return (y > 0.0f ? half_pi : -half_pi) - angle;
}

// Arc cosine and sine through atan2, which keeps its accuracy near +-1.
inline float acos(float x) { return atan2(sqrt(max(0.0f, (1.0f - x) * (1.0f + x))), x); }
inline float asin(float x) { return atan2(x, sqrt(max(0.0f, (1.0f - x) * (1.0f + x)))); }

// e^x in double: 2^k times a Taylor series on |r| <= ln(2)/2. Underflows to 0, overflows to infinity.
inline double exp(double x) {
  if (x < -708.0) return 0.0;
  if (x > 709.0) return static_cast<double>(infinity);
  const double k = floor(fma(x, 1.4426950408889634074, 0.5));
  double r = fma(k, -0x1.62e42fefa39efp-1, x);
  r = fma(k, -0x1.abc9e3b39803fp-56, r);
  double sum = 1.0;
  for (int32_t n = 14; n > 0; --n) sum = fma(sum * r, 1.0 / n, 1.0);
  return sum * double_of(static_cast<uint64_t>(static_cast<int64_t>(k) + 1023) << 52);
}

// e^x in single precision (coefficients as in Cephes expf; Moshier 1989); flushed to 0 below -87, held above 88.
inline float exp(float x) {
  if (x < -87.0f) return 0.0f;
  x = min(x, 88.0f);
  const float k = floor(fma(x, 1.44269504088896341f, 0.5f));
  const float r = fma(k, 2.12194440e-4f, fma(k, -0.693359375f, x));
  float p = fma(1.9875691500e-4f, r, 1.3981999507e-3f);
  p = fma(p, r, 8.3334519073e-3f);
  p = fma(p, r, 4.1665795894e-2f);
  p = fma(p, r, 1.6666665459e-1f);
  p = fma(p, r, 5.0000001201e-1f);
  return (fma(p, r * r, r) + 1.0f) * float_of(static_cast<uint32_t>(static_cast<int32_t>(k) + 127) << 23);
}

// Natural logarithm of a positive normal double: m 2^k with m in [sqrt(1/2), sqrt(2)), atanh series in
// (m - 1)/(m + 1).
inline double log(double x) {
  uint64_t bits = bits_of(x);
  int64_t k = static_cast<int64_t>(bits >> 52) - 1023;
  double m = double_of((bits & 0x000fffffffffffffull) | 0x3ff0000000000000ull);
  if (m > 1.4142135623730951) {
    m *= 0.5;
    ++k;
  }
  const double s = (m - 1.0) / (m + 1.0);
  const double z = s * s;
  double sum = 0.0;
  for (int32_t n = 27; n > 0; n -= 2) sum = fma(sum, z, 1.0 / n);
  return fma(static_cast<double>(k), 0x1.62e42fefa39efp-1,
             fma(static_cast<double>(k), 0x1.abc9e3b39803fp-56, 2.0 * s * sum));
}

struct SinCosDouble {
  double sin, cos;
};

// Sine and cosine in double for |x| up to some thousands: Taylor series after removing the quadrant.
inline SinCosDouble sincos(double x) {
  const double k = floor(fma(x, 0.63661977236758134308, 0.5));
  double r = fma(k, -0x1.921fb54442d18p+0, x);
  r = fma(k, -0x1.1a62633145c07p-54, r);
  const double z = r * r;
  double s = 1.0;
  double c = 1.0;
  for (int32_t n = 20; n > 0; n -= 2) {
    s = fma(s, -z / (static_cast<double>(n) * (n + 1)), 1.0);
    c = fma(c, -z / (static_cast<double>(n) * (n - 1)), 1.0);
  }
  s *= r;
  const int32_t quadrant = static_cast<int32_t>(k) & 3;
  const double sine = (quadrant & 1) != 0 ? c : s;
  const double cosine = (quadrant & 1) != 0 ? s : c;
  return {(quadrant & 2) != 0 ? -sine : sine, ((quadrant + 1) & 2) != 0 ? -cosine : cosine};
}

inline double pow(double x, double y) { return x <= 0.0 ? 0.0 : exp(y * log(x)); }

}  // namespace accuray
