// Three-vectors and orthonormal frames.
#pragma once

#include "kernels/port.h"

namespace accuray {

struct Vec2 {
  float x, y;
};

struct Vec3 {
  float x, y, z;
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline Vec3 operator*(float s, Vec3 a) { return a * s; }
inline Vec3 fma(float s, Vec3 a, Vec3 b) { return {fma(s, a.x, b.x), fma(s, a.y, b.y), fma(s, a.z, b.z)}; }

inline float dot(Vec3 a, Vec3 b) { return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)); }
inline float length_squared(Vec3 a) { return dot(a, a); }
inline float length(Vec3 a) { return sqrt(length_squared(a)); }
inline Vec3 normalize(Vec3 a) { return a * (1.0f / length(a)); }
inline Vec3 abs(Vec3 a) { return {abs(a.x), abs(a.y), abs(a.z)}; }
inline Vec3 min(Vec3 a, Vec3 b) { return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)}; }
inline Vec3 max(Vec3 a, Vec3 b) { return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)}; }
inline float max_component(Vec3 a) { return max(a.x, max(a.y, a.z)); }

// a*b - c*d with one rounding error less than the plain form (Kahan; see Jeannerod, Louvet and Muller 2013).
inline float difference_of_products(float a, float b, float c, float d) {
  const float cd = c * d;
  const float difference = fma(a, b, -cd);
  const float error = fma(-c, d, cd);
  return difference + error;
}

inline Vec3 cross(Vec3 a, Vec3 b) {
  return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
          difference_of_products(a.x, b.y, a.y, b.x)};
}

inline bool is_finite(float x) { return (bits_of(x) & 0x7f800000u) != 0x7f800000u; }
inline bool is_finite(Vec3 a) { return is_finite(a.x) && is_finite(a.y) && is_finite(a.z); }

// Orthonormal basis around a unit normal: x = tangent, y = bitangent, z = normal.
struct Frame {
  Vec3 x, y, z;

  // Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
  static Frame around(Vec3 n) {
    const float sign = float_of((bits_of(n.z) & 0x80000000u) | 0x3f800000u);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    return {{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
  }
  // With x as close to `tangent` as the unit normal n lets it be; any x if they are parallel.
  static Frame along(Vec3 n, Vec3 tangent) {
    const Vec3 across = cross(n, tangent);
    const float squared = length_squared(across);
    if (!(squared > 0.0f) || !is_finite(squared)) return around(n);
    const Vec3 y = across * (1.0f / sqrt(squared));
    return {cross(y, n), y, n};
  }
  Vec3 to_local(Vec3 v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
  Vec3 to_world(Vec3 v) const { return fma(v.x, x, fma(v.y, y, z * v.z)); }
};

}  // namespace accuray
