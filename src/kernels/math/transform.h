// Rigid transforms with uniform scale (mirroring allowed), as three rows of four.
#pragma once

#include "kernels/math/vec.h"

namespace accuray {

struct Transform {
  float m[3][4];

  Vec3 point(Vec3 p) const {
    return {fma(m[0][0], p.x, fma(m[0][1], p.y, fma(m[0][2], p.z, m[0][3]))),
            fma(m[1][0], p.x, fma(m[1][1], p.y, fma(m[1][2], p.z, m[1][3]))),
            fma(m[2][0], p.x, fma(m[2][1], p.y, fma(m[2][2], p.z, m[2][3])))};
  }
  Vec3 vector(Vec3 v) const {
    return {fma(m[0][0], v.x, fma(m[0][1], v.y, m[0][2] * v.z)), fma(m[1][0], v.x, fma(m[1][1], v.y, m[1][2] * v.z)),
            fma(m[2][0], v.x, fma(m[2][1], v.y, m[2][2] * v.z))};
  }
  // What point() maps to q.
  Vec3 point_back(Vec3 q) const { return vector_back({q.x - m[0][3], q.y - m[1][3], q.z - m[2][3]}); }
  // What vector() maps to v: the columns are perpendicular and of one length.
  Vec3 vector_back(Vec3 v) const {
    const Vec3 x = {m[0][0], m[1][0], m[2][0]};
    const Vec3 y = {m[0][1], m[1][1], m[2][1]};
    const Vec3 z = {m[0][2], m[1][2], m[2][2]};
    return Vec3{dot(x, v), dot(y, v), dot(z, v)} * (1.0f / dot(x, x));
  }
  // Sum of the magnitudes that are added in point(): what its rounding error is proportional to.
  Vec3 magnitude(Vec3 p) const {
    const Vec3 a = abs(p);
    return {abs(m[0][0]) * a.x + abs(m[0][1]) * a.y + abs(m[0][2]) * a.z + abs(m[0][3]),
            abs(m[1][0]) * a.x + abs(m[1][1]) * a.y + abs(m[1][2]) * a.z + abs(m[1][3]),
            abs(m[2][0]) * a.x + abs(m[2][1]) * a.y + abs(m[2][2]) * a.z + abs(m[2][3])};
  }
  // An upper bound of |linear part| applied to a vector of magnitudes.
  Vec3 spread(Vec3 e) const {
    return {abs(m[0][0]) * e.x + abs(m[0][1]) * e.y + abs(m[0][2]) * e.z,
            abs(m[1][0]) * e.x + abs(m[1][1]) * e.y + abs(m[1][2]) * e.z,
            abs(m[2][0]) * e.x + abs(m[2][1]) * e.y + abs(m[2][2]) * e.z};
  }
};

}  // namespace accuray
