// What every texture offers.
//
// A texture is a struct X of parameters with value(scene, point), listed in list.h.
//
// Conventions
//   - A value has four components: linear Rec.709 red, green and blue, and alpha (1 where there is none). Where a
//     number is asked for, it is one of these components.
//   - u runs to the right and v upwards: uv (0, 0) is the lower left corner of a picture, (1, 1) its upper right one.
//   - X::reads_uv says that shapes need texture coordinates of their own; other textures read the point itself, or, if
//     X::reads_colors is there, what is stored at the vertices of meshes.
//   - step() is a distance over which the value changes little, for slopes: of coordinates, or metres.
#pragma once

#include "kernels/geometry/texture_point.h"
#include "kernels/schema.h"

namespace accuray {

using TextureValue = f32x4;

// From a surface's coordinates to a texture's: scaled first, then rotated, then moved. The lowering fills it from the
// parameters of uv_params().
struct UvMap {
  float m[2][3];

  Vec2 at(Vec2 uv) const {
    return {fma(m[0][0], uv.x, fma(m[0][1], uv.y, m[0][2])), fma(m[1][0], uv.x, fma(m[1][1], uv.y, m[1][2]))};
  }
};

constexpr auto uv_params() {
  return param_list(
      Param{.name = "uv_scale",
            .kind = Kind::vec,
            .doc = "Factors of the shape's texture coordinates u and v: how often the texture fits into 0 to 1.",
            .preset = "[1, 1]",
            .animatable = true},
      Param{.name = "uv_rotate",
            .kind = Kind::real,
            .doc = "Angle by which the scaled coordinates are turned, counter-clockwise.",
            .preset = "0",
            .unit = "deg",
            .animatable = true},
      Param{.name = "uv_translate",
            .kind = Kind::vec,
            .doc = "What is added to the coordinates at the end.",
            .preset = "[0, 0]",
            .animatable = true});
}

// A colour of a procedural texture as linear Rec.709.
constexpr Param colour_param(const char* name, const char* doc, const char* preset, uint32_t member) {
  return {
      .name = name, .kind = Kind::vec, .doc = doc, .preset = preset, .low = 0, .animatable = true, .member = member};
}

inline TextureValue opaque(Vec3 rgb) { return lanes(rgb.x, rgb.y, rgb.z, 1.0f); }
inline TextureValue mixed(Vec3 a, Vec3 b, float share) { return opaque(fma(share, b - a, a)); }

// x - floor(x), and 0 for what is not finite.
inline float fraction_of(float x) {
  const float f = x - floor(x);
  return f >= 0.0f && f < 1.0f ? f : 0.0f;
}

}  // namespace accuray
