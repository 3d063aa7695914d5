#include "lower/environments.h"

#include <algorithm>

namespace accuray {

namespace {

// Of linear Rec.709 (ITU-R BT.709).
constexpr double kLuminance[3] = {0.2126, 0.7152, 0.0722};

std::vector<float> texel_luminance(const Picture& picture, const float* decode) {
  const size_t texels = static_cast<size_t>(picture.width) * picture.height;
  const size_t channels = picture.channels;
  std::vector<float> result(texels);
  for (size_t i = 0; i < texels; ++i) {
    const auto stored = [&](size_t c) { return static_cast<double>(stored_number(picture, i * channels + c, decode)); };
    double sum = stored(0);
    if (channels >= 3) sum = kLuminance[0] * sum + kLuminance[1] * stored(1) + kLuminance[2] * stored(2);
    result[i] = static_cast<float>(std::max(sum, 0.0));
  }
  return result;
}

// Mean over the middle cell of the lines through three neighbouring values.
float mean_between(float before, float here, float after) { return 0.125f * (before + after) + 0.75f * here; }

// Each texel's cell: the mean of the bilinear surface, first along the rows, then across them.
void blur(std::vector<float>& values, uint32_t width, uint32_t height) {
  std::vector<float> line(width);
  for (uint32_t y = 0; y < height; ++y) {
    float* row = values.data() + static_cast<size_t>(y) * width;
    std::copy(row, row + width, line.begin());
    for (uint32_t x = 0; x < width; ++x) {
      row[x] = mean_between(line[x == 0 ? width - 1 : x - 1], line[x], line[x + 1 == width ? 0 : x + 1]);
    }
  }
  line.resize(height);
  for (uint32_t x = 0; x < width; ++x) {
    const auto at = [&](uint32_t y) -> float& { return values[static_cast<size_t>(y) * width + x]; };
    for (uint32_t y = 0; y < height; ++y) line[y] = at(y);
    for (uint32_t y = 0; y < height; ++y) {
      at(y) = mean_between(line[y == 0 ? 0 : y - 1], line[y], line[y + 1 == height ? y : y + 1]);
    }
  }
}

// `parts` x `parts` cells of each texel, an even number: on none of them the bilinear surface has a fold, so its mean
// is its value in the middle.
RadianceCells refined(const RadianceCells& texels, uint32_t parts) {
  RadianceCells fine{{}, texels.width * parts, texels.height * parts};
  fine.values.reserve(static_cast<size_t>(fine.width) * fine.height);
  const auto axis = [&](uint32_t i, uint32_t count, Wrap wrap) {
    const float t = (static_cast<float>(i) + 0.5f) / static_cast<float>(count * parts);
    return texels_at(t, count, wrap, false);
  };
  const auto texel = [&](int32_t x, int32_t y) {
    return lanes(texels.values[static_cast<size_t>(y) * texels.width + static_cast<size_t>(x)]);
  };
  for (uint32_t j = 0; j < fine.height; ++j) {
    const TexelPair y = axis(j, texels.height, Wrap::clamp);
    for (uint32_t i = 0; i < fine.width; ++i) {
      fine.values.push_back(bilinear(axis(i, texels.width, Wrap::repeat), y, texel)[0]);
    }
  }
  return fine;
}

// How finely the texels of a small picture are cut.
uint32_t parts_of(const Picture& picture) {
  constexpr uint64_t enough_cells = uint64_t{1} << 18;
  uint32_t parts = 8;
  while (parts > 1 && uint64_t{picture.width} * picture.height * parts * parts > enough_cells) parts /= 2;
  return parts;
}

// Cells of `size` x `size` of the given ones; the last ones of a row or column may stand for fewer.
RadianceCells gathered(const RadianceCells& fine, uint32_t size) {
  RadianceCells coarse{{}, fine.width / size, fine.height / size};
  coarse.values.reserve(static_cast<size_t>(coarse.width) * coarse.height);
  const auto first = [](uint64_t i, uint64_t from, uint64_t to) { return i * from / to; };
  for (uint32_t j = 0; j < coarse.height; ++j) {
    for (uint32_t i = 0; i < coarse.width; ++i) {
      double sum = 0.0;
      uint64_t count = 0;
      for (uint64_t y = first(j, fine.height, coarse.height); y * coarse.height < (j + uint64_t{1}) * fine.height;
           ++y) {
        for (uint64_t x = first(i, fine.width, coarse.width); x * coarse.width < (i + uint64_t{1}) * fine.width; ++x) {
          sum += static_cast<double>(fine.values[y * fine.width + x]);
          ++count;
        }
      }
      coarse.values.push_back(static_cast<float>(sum / static_cast<double>(count)));
    }
  }
  return coarse;
}

// How the kernels read the picture: bilinearly, around the sides, held at the poles.
Values image_values() {
  return {{"filter", static_cast<double>(TexelFilter::bilinear)},
          {"wrap_u", static_cast<double>(Wrap::repeat)},
          {"wrap_v", static_cast<double>(Wrap::clamp)},
          {"uv_scale", std::array{1.0, 1.0, 0.0}},
          {"uv_rotate", 0.0},
          {"uv_translate", std::array{0.0, 0.0, 0.0}}};
}

}  // namespace

RadianceCells luminance_cells(const Picture& picture, const float* decode) {
  RadianceCells cells{texel_luminance(picture, decode), picture.width, picture.height};
  if (const uint32_t parts = parts_of(picture); parts > 1) return refined(cells, parts);
  blur(cells.values, cells.width, cells.height);
  uint32_t size = 1;
  while (static_cast<uint64_t>(cells.width / size) * (cells.height / size) > most_cells) size *= 2;
  return size == 1 ? std::move(cells) : gathered(cells, size);
}

const EnvironmentMap& EnvironmentPool::map_of(const PictureUse& use) {
  const std::pair key{use.picture, use.srgb};
  const auto found = maps_.find(key);
  if (found != maps_.end()) return found->second;
  const uint32_t texture = textures_.add(ImageTexture::name, image_values(), use);
  auto& made = textures_.shared(use).radiance;
  if (!made.contains(use.srgb)) {
    const RadianceCells cells = luminance_cells(textures_.picture(use), textures_.decoding(use));
    made[use.srgb] = {direction_sections(cells), mean_of(cells)};
  }
  const RadianceMap& radiance = made[use.srgb];
  return maps_.emplace(key, EnvironmentMap{texture, place(radiance.directions, bulk_), radiance.mean}).first->second;
}

}  // namespace accuray
