// A picture from a file or an array, read bilinearly, or trilinearly from mipmaps.
//
// Texels are kept as the file has them, 8 or 16 bit integers, half or single precision floats, in a section of their
// own, row by row from the top. Integers become numbers through a table (sRGB, IEC 61966-2-1) or by division.
#pragma once

#include "kernels/texture/mipmap.h"

namespace accuray {

struct ImageTexture {
  Slice<uint8_t> texels;
  UvMap map;
  Wrap wrap_u, wrap_v;
  TexelFilter filter;
  uint32_t width, height, channels;
  TexelFormat format;
  Mipmaps mipmaps;  // smaller and smaller, for that filter
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
                  .doc =
                      "Between texels: bilinear, or the nearest one; or mipmap, which averages over what a ray stands "
                      "for: less noise from afar, and more blur.",
                  .preset = "\"bilinear\"",
                  .choices = "bilinear|nearest|mipmap",
                  .member = ACCURAY_OFFSET_OF(ImageTexture, filter)},
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
    if (filter == TexelFilter::mipmap && p.footprint > 0.0f) {
      const float level = mip_level(p, map, width, height, mipmaps.count);
      if (level > 0.0f) return filtered(scene, uv, level);
    }
    return stored(scene, uv);
  }

 private:
  TextureValue stored(const SceneView& scene, Vec2 uv) const {
    const TexelPair x = texels_at(uv.x, width, wrap_u, filter == TexelFilter::nearest);
    const TexelPair y = texels_at(1.0f - uv.y, height, wrap_v, filter == TexelFilter::nearest);
    return bilinear(x, y, [&](int32_t i, int32_t j) { return texel(scene, i, j); });
  }
  // Between the two levels that lie next to this one.
  TextureValue filtered(const SceneView& scene, Vec2 uv, float level) const {
    const auto fine = static_cast<uint32_t>(level);
    const float share = level - static_cast<float>(fine);
    const TextureValue a = fine == 0 ? stored(scene, uv) : smaller(scene, uv, fine);
    if (share == 0.0f) return a;
    return fma(lanes(share), smaller(scene, uv, fine + 1) - a, a);
  }
  TextureValue smaller(const SceneView& scene, Vec2 uv, uint32_t level) const {
    const MipLevel mip = mip_at(scene, mipmaps, width, height, channels, level);
    const TexelPair x = texels_at(uv.x, mip.width, wrap_u, false);
    const TexelPair y = texels_at(1.0f - uv.y, mip.height, wrap_v, false);
    return bilinear(x, y, [&](int32_t i, int32_t j) { return mip.texel(i, j, channels); });
  }
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
