// Texels on a grid: how they are stored, which of them a coordinate lies between, and what is outside.
#pragma once

#include "kernels/texture/texture.h"

namespace accuray {

enum class TexelFormat : uint32_t { u8, u16, half, single };
enum class TexelFilter : uint32_t { bilinear, nearest, mipmap };
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

// Between the four texels of two pairs; fetch(x, y) gives one.
template <class Fetch>
inline TextureValue bilinear(const TexelPair& x, const TexelPair& y, const Fetch& fetch) {
  const auto between = [](TextureValue a, TextureValue b, float share) { return fma(lanes(share), b - a, a); };
  const TextureValue upper = between(fetch(x.low, y.low), fetch(x.high, y.low), x.fraction);
  const TextureValue lower = between(fetch(x.low, y.high), fetch(x.high, y.high), x.fraction);
  return between(upper, lower, y.fraction);
}

}  // namespace accuray
