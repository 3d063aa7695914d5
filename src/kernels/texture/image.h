// A picture from a file or an array, read bilinearly.
//
// Texels are kept as the file has them, 8 or 16 bit integers, half or single precision floats, in a section of their
// own, row by row from the top. Integers become numbers through a table (sRGB, IEC 61966-2-1) or by division.
#pragma once

#include "kernels/texture/texture.h"

namespace accuray {

enum class TexelFormat : uint32_t { u8, u16, half, single };
enum class Wrap : uint32_t { repeat, mirror, clamp, black };

// Half precision to single, exact; infinities are not kept apart, the lowering takes finite texels only.
inline float half_to_float(uint32_t bits) {
  const float magnitude = float_of((bits & 0x7fffu) << 13) * 0x1p112f;
  return float_of(bits_of(magnitude) | ((bits & 0x8000u) << 16));
}

// The two texels on an axis that a coordinate lies between, and how far from the first to the second. -1: outside.
struct TexelPair {
  int32_t low, high;
  float fraction;
};

// Position of texel i on an axis of n after wrapping; i is at most one beyond the ends, or outside and black.
inline int32_t wrapped(int32_t i, int32_t n, Wrap wrap) {
  if (i >= 0 && i < n) return i;
  if (wrap == Wrap::repeat) return i < 0 ? i + n : i - n;
  return wrap == Wrap::black ? -1 : clamp(i, 0, n - 1);
}

// t runs from 0 to 1 over n texels, whose centres are at (i + 1/2) / n.
inline TexelPair texels_at(float t, uint32_t count, Wrap wrap, bool nearest) {
  float low = 0.0f;
  float high = 1.0f;
  if (wrap == Wrap::repeat) {
    t = fraction_of(t);
  } else if (wrap == Wrap::mirror) {
    const float half = 2.0f * fraction_of(0.5f * t);
    t = half > 1.0f ? 2.0f - half : half;
  } else if (wrap == Wrap::black) {
    low = -1.0f;
    high = 2.0f;
  }
  t = min(max(low, t), high);  // this order makes NaN `low`
  const auto n = static_cast<int32_t>(count);
  const float x = nearest ? t * static_cast<float>(count) : fma(t, static_cast<float>(count), -0.5f);
  const float whole = floor(x);
  const int32_t first = clamp(static_cast<int32_t>(whole), -n - 1, 2 * n);
  return {wrapped(first, n, wrap), wrapped(first + 1, n, wrap), nearest ? 0.0f : x - whole};
}

struct ImageTexture {
  Slice<uint8_t> texels;
  UvMap map;
  Wrap wrap_u, wrap_v;
  uint32_t nearest;
  uint32_t width, height, channels;
  TexelFormat format;
  uint32_t decode;  // of colours: first entry of a table in the scene's tables; none: integers are divided

  static constexpr const char* name = "image";
  static constexpr const char* doc =
      "A picture. One channel is grey, two are grey and alpha, three red, green and blue, four those and alpha.";
  static constexpr bool reads_uv = true;
  static constexpr auto params() {
    return joined(
        param_list(
            Param{.name = "file",
                  .kind = Kind::file,
                  .doc = "Image file: PNG, JPEG, OpenEXR, HDR, TIFF and whatever else OpenImageIO reads.",
                  .role = "image",
                  .group = "source:file"},
            Param{.name = "pixels",
                  .kind = Kind::array,
                  .doc = "The picture itself, height x width or height x width x channels, from the top; integers of 8 "
                         "or 16 bits count as 0 to 1.",
                  .role = "pixels",
                  .group = "source:pixels"},
            Param{.name = "color_space",
                  .kind = Kind::choice,
                  .doc = "What the stored colours are: srgb (the sRGB curve is undone), linear (linear Rec.709) or "
                         "data (plain numbers). auto: integers are srgb where the texture gives a spectrum, data "
                         "where it gives a number; floats are linear.",
                  .preset = "\"auto\"",
                  .choices = "auto|srgb|linear|data"},
            Param{.name = "filter",
                  .kind = Kind::choice,
                  .doc = "Between texels: bilinear, or the nearest one.",
                  .preset = "\"bilinear\"",
                  .choices = "bilinear|nearest",
                  .member = ACCURAY_OFFSET_OF(ImageTexture, nearest)},
            Param{.name = "wrap_u",
                  .kind = Kind::choice,
                  .doc = "Left and right of the picture: it is repeated, mirrored, its edge goes on, or all is black "
                         "and transparent.",
                  .preset = "\"repeat\"",
                  .choices = "repeat|mirror|clamp|black",
                  .member = ACCURAY_OFFSET_OF(ImageTexture, wrap_u)},
            Param{.name = "wrap_v",
                  .kind = Kind::choice,
                  .doc = "Above and below, likewise.",
                  .preset = "\"repeat\"",
                  .choices = "repeat|mirror|clamp|black",
                  .member = ACCURAY_OFFSET_OF(ImageTexture, wrap_v)}),
        uv_params());
  }

  float step() const { return 0.5f / static_cast<float>(max(width, height)); }
  TextureValue value(const SceneView& scene, const TexturePoint& p) const {
    const Vec2 uv = map.at(p.uv);
    const TexelPair x = texels_at(uv.x, width, wrap_u, nearest != 0);
    const TexelPair y = texels_at(1.0f - uv.y, height, wrap_v, nearest != 0);
    const TextureValue upper = between(texel(scene, x.low, y.low), texel(scene, x.high, y.low), x.fraction);
    const TextureValue lower = between(texel(scene, x.low, y.high), texel(scene, x.high, y.high), x.fraction);
    return between(upper, lower, y.fraction);
  }

 private:
  static TextureValue between(TextureValue a, TextureValue b, float share) { return fma(lanes(share), b - a, a); }

  TextureValue texel(const SceneView& scene, int32_t x, int32_t y) const {
    if (x < 0 || y < 0) return lanes(0.0f);
    const uint8_t* bytes = scene.at(texels);
    const size_t first = (static_cast<size_t>(y) * width + static_cast<size_t>(x)) * channels;
    const float* table = decode == none ? nullptr : scene.tables + decode;
    const float c0 = component(bytes, first, table);
    if (channels < 3) return lanes(c0, c0, c0, channels == 2 ? component(bytes, first + 1, nullptr) : 1.0f);
    return lanes(c0, component(bytes, first + 1, table), component(bytes, first + 2, table),
                 channels == 4 ? component(bytes, first + 3, nullptr) : 1.0f);
  }
  float component(const uint8_t* bytes, size_t i, const float* table) const {
    switch (format) {
      case TexelFormat::u8:
        return table != nullptr ? table[bytes[i]] : static_cast<float>(bytes[i]) / 255.0f;
      case TexelFormat::u16: {
        const uint32_t stored = reinterpret_cast<const uint16_t*>(bytes)[i];
        return table != nullptr ? table[stored] : static_cast<float>(stored) / 65535.0f;
      }
      case TexelFormat::half:
        return half_to_float(reinterpret_cast<const uint16_t*>(bytes)[i]);
      case TexelFormat::single:
        break;
    }
    return reinterpret_cast<const float*>(bytes)[i];
  }
};

}  // namespace accuray
