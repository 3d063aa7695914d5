// Vectors of three doubles, for geometry that is computed while lowering and rounded once.
#pragma once

#include <array>
#include <cmath>

namespace accuray {

using Double3 = std::array<double, 3>;

inline Double3 combined(double s, const Double3& a, double t, const Double3& b) {
  return {s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]};
}
inline Double3 sum(const Double3& a, const Double3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Double3 difference(const Double3& a, const Double3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline double dot(const Double3& a, const Double3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Double3 cross(const Double3& a, const Double3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Double3& a) { return std::sqrt(dot(a, a)); }
inline Double3 scaled(double s, const Double3& a) { return {s * a[0], s * a[1], s * a[2]}; }

}  // namespace accuray
