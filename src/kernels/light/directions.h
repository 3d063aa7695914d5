// Directions as places of an equirectangular map, and tables by which they are drawn.
//
// Conventions
//   - The middle of a map lies at -Z, where cameras look by default, its right half towards +X, its top row around +Y:
//     a map is what a panorama camera sees.
//   - A place is (x, y) in [0, 1]: x to the right, y down; the polar angle from +Y is pi y.
#pragma once

#include "kernels/math/functions.h"
#include "kernels/math/interval.h"
#include "kernels/scene_view.h"

namespace accuray {

inline Vec2 map_place(Vec3 direction) {
  const float around = sqrt(fma(direction.x, direction.x, direction.z * direction.z));
  return {fma(atan2(direction.x, -direction.z), 0.5f * inv_pi, 0.5f), atan2(around, direction.y) * inv_pi};
}
inline Vec3 map_direction(Vec2 place) {
  const SinCos longitude = sincos((place.x - 0.5f) * (2.0f * pi));
  const SinCos polar = sincos(place.y * pi);
  return {polar.sin * longitude.sin, polar.cos, -(polar.sin * longitude.cos)};
}

// A density that is constant in each of width x height cells of the map: running sums over the rows, and over the
// cells of each row, each with a guide to its intervals: without, looking them up is a fifth of the time in a room
// behind a window. All sums are zero if nothing is to be drawn.
struct DirectionTable {
  Slice<float> rows;             // height + 1
  Slice<float> columns;          // height x (width + 1)
  Slice<uint32_t> row_guide;     // row_parts + 1
  Slice<uint32_t> column_guide;  // height x (column_parts + 1)
  uint32_t width, height, row_parts, column_parts;

  // A drawn direction; only pdf() tells its density, so that both ways to it agree in every bit.
  Vec3 sample(const SceneView& scene, Vec2 u) const {
    const float* row_sums = scene.at(rows);
    const uint32_t row = guided_interval_of(row_sums, scene.at(row_guide), row_parts, u.y);
    const float* sums = scene.at(columns) + static_cast<size_t>(row) * (width + 1);
    const uint32_t* guide = scene.at(column_guide) + static_cast<size_t>(row) * (column_parts + 1);
    const uint32_t column = guided_interval_of(sums, guide, column_parts, u.x);
    return map_direction({within(sums, column, width, u.x), within(row_sums, row, height, u.y)});
  }
  // Per solid angle; 0 at the poles themselves, which have none.
  float pdf(const SceneView& scene, Vec3 direction) const {
    const Vec2 place = map_place(direction);
    const uint32_t row = min(static_cast<uint32_t>(place.y * static_cast<float>(height)), height - 1u);
    const uint32_t column = min(static_cast<uint32_t>(place.x * static_cast<float>(width)), width - 1u);
    const float* row_sums = scene.at(rows);
    const float* sums = scene.at(columns) + static_cast<size_t>(row) * (width + 1);
    const float share = (row_sums[row + 1] - row_sums[row]) * (sums[column + 1] - sums[column]);
    const float around = sqrt(fma(direction.x, direction.x, direction.z * direction.z));
    if (!(around > 0.0f)) return 0.0f;
    return share * static_cast<float>(width) * static_cast<float>(height) / (2.0f * pi * pi * around);
  }

 private:
  // Position on the axis of what u picked out of its interval.
  static float within(const float* sums, uint32_t interval, uint32_t count, float u) {
    const float share = sums[interval + 1] - sums[interval];
    const float part = share > 0.0f ? clamp((u - sums[interval]) / share, 0.0f, one_minus_epsilon) : 0.5f;
    return (static_cast<float>(interval) + part) / static_cast<float>(count);
  }
};

}  // namespace accuray
