#include "lower/mipmaps.h"

#include <algorithm>
#include <bit>

#include "kernels/texture/mipmap.h"

namespace accuray {

float stored_number(const Picture& picture, size_t i, const float* decode) {
  const uint8_t* bytes = picture.texels.data;
  switch (picture.format) {
    case TexelFormat::u8:
      return decode != nullptr ? decode[bytes[i]] : static_cast<float>(bytes[i]) / 255.0f;
    case TexelFormat::u16: {
      const uint32_t stored = reinterpret_cast<const uint16_t*>(bytes)[i];
      return decode != nullptr ? decode[stored] : static_cast<float>(stored) / 65535.0f;
    }
    case TexelFormat::half:
      return half_to_float(reinterpret_cast<const uint16_t*>(bytes)[i]);
    case TexelFormat::single:
      break;
  }
  return reinterpret_cast<const float*>(bytes)[i];
}

namespace {

// What is added to `target` when each of its `to` cells of `channels` numbers gets the mean of what it covers of the
// `from` cells of `source`, times `weight`.
void add_means(const float* source, size_t from, double weight, double* target, size_t to, size_t channels) {
  const double ratio = static_cast<double>(from) / static_cast<double>(to);
  for (size_t i = 0; i < to; ++i) {
    const double begin = static_cast<double>(i) * ratio;
    const double end = begin + ratio;
    for (size_t k = static_cast<size_t>(begin); k < from && static_cast<double>(k) < end; ++k) {
      const double x = static_cast<double>(k);
      const double covered = std::min(x + 1.0, end) - std::max(x, begin);
      for (size_t c = 0; c < channels; ++c) {
        target[i * channels + c] += weight * covered / ratio * static_cast<double>(source[k * channels + c]);
      }
    }
  }
}

// One level from the one before, whose rows read_row(y) gives; appended to `result`.
template <class ReadRow>
void append_level(size_t width, size_t height, size_t channels, const ReadRow& read_row, std::vector<float>& result) {
  const size_t rows = std::max<size_t>(height / 2, 1);
  const size_t columns = std::max<size_t>(width / 2, 1);
  const double ratio = static_cast<double>(height) / static_cast<double>(rows);
  std::vector<double> row(columns * channels);
  for (size_t j = 0; j < rows; ++j) {
    std::fill(row.begin(), row.end(), 0.0);
    const double begin = static_cast<double>(j) * ratio;
    const double end = begin + ratio;
    for (size_t k = static_cast<size_t>(begin); k < height && static_cast<double>(k) < end; ++k) {
      const double y = static_cast<double>(k);
      const double covered = std::min(y + 1.0, end) - std::max(y, begin);
      add_means(read_row(k), width, covered / ratio, row.data(), columns, channels);
    }
    for (const double value : row) result.push_back(static_cast<float>(value));
  }
}

}  // namespace

uint32_t mipmap_count(uint32_t width, uint32_t height) {
  return static_cast<uint32_t>(std::bit_width(std::max(width, height))) - 1;
}

std::vector<float> make_mipmaps(const Picture& picture, const float* decode) {
  const size_t channels = picture.channels;
  const auto is_alpha = [&](size_t c) { return (channels == 2 && c == 1) || c == 3; };
  std::vector<float> decoded(picture.width * channels);
  const auto stored_row = [&](size_t y) {
    const size_t first = y * picture.width * channels;
    for (size_t i = 0; i < decoded.size(); ++i) {
      decoded[i] = stored_number(picture, first + i, is_alpha(i % channels) ? nullptr : decode);
    }
    return decoded.data();
  };
  std::vector<float> result;
  const uint32_t count = mipmap_count(picture.width, picture.height);
  if (count > 0) append_level(picture.width, picture.height, channels, stored_row, result);
  size_t last = 0;  // where the latest level starts
  for (uint32_t level = 2; level <= count; ++level) {
    const size_t width = mip_size(picture.width, level - 1);
    const size_t height = mip_size(picture.height, level - 1);
    const std::vector<float> before(result.begin() + static_cast<ptrdiff_t>(last), result.end());
    last = result.size();
    append_level(width, height, channels, [&](size_t y) { return before.data() + y * width * channels; }, result);
  }
  return result;
}

}  // namespace accuray
