// The pixels of one tile: their sums until all are done, and the loop over their samples.
#pragma once

#include <algorithm>
#include <atomic>
#include <vector>

#include "engine/pass.h"

namespace accuray {

// Sums of some pixels: by pixel, replicate and channel as in FilmView.
class PartialFilm {
 public:
  PartialFilm(uint32_t pixels, uint32_t replicates, uint32_t channels)
      : replicates_(replicates),
        channels_(channels),
        sums_(static_cast<size_t>(pixels) * replicates * channels),
        dropped_(static_cast<size_t>(pixels) * replicates) {}

  void add(uint32_t pixel, uint32_t replicate, const Quantized& sample) {
    if (!sample.finite) return drop(pixel, replicate);
    add_to<film_channels>(pixel, replicate, 0, sample);
  }
  // Indirect light is a part of the sample's light, so it is finite where that is.
  void add(uint32_t pixel, uint32_t replicate, const LayeredSample& sample) {
    if (!sample.picture.finite || !sample.indirect.finite) return drop(pixel, replicate);
    add_to<film_channels>(pixel, replicate, 0, sample.picture);
    add_to<layer_channels>(pixel, replicate, film_channels, sample.indirect);
  }
  // Adds one of these pixels to a pixel of the film.
  void flush(uint32_t pixel, const FilmView& film, uint64_t target) const {
    for (uint32_t r = 0; r < replicates_; ++r) {
      const size_t from = slot(pixel, r);
      const uint64_t to = target * replicates_ + r;
      bool fits = true;
      for (uint32_t c = 0; c < channels_; ++c) {
        fits &= add_checked(film.sums[to * channels_ + c], sums_[from * channels_ + c]);
      }
      if (!fits) throw_overflow();
      film.dropped[to] += dropped_[from];
    }
  }

 private:
  [[noreturn]] static void throw_overflow() {
    throw FilmOverflow("a pixel's sum no longer fits 64 bits: choose a larger film unit");
  }
  size_t slot(uint32_t pixel, uint32_t replicate) const { return static_cast<size_t>(pixel) * replicates_ + replicate; }
  void drop(uint32_t pixel, uint32_t replicate) { ++dropped_[slot(pixel, replicate)]; }

  template <uint32_t count>
  void add_to(uint32_t pixel, uint32_t replicate, uint32_t first, const Quantized& sample) {
    int64_t* sums = &sums_[slot(pixel, replicate) * channels_ + first];
    bool fits = true;
    for (uint32_t c = 0; c < count; ++c) fits &= add_checked(sums[c], sample.value[c]);
    if (!fits) throw_overflow();
  }

  uint32_t replicates_, channels_;
  std::vector<int64_t> sums_;
  std::vector<uint32_t> dropped_;
};

// Adds what sample(x, y, index) gives for samples [first, first + count) of every pixel of a tile; x and y count from
// the window's corner. False, and the film untouched, if `stop` turned true meanwhile.
template <class SampleOf>
bool add_tile(const FilmView& film, uint32_t replicates, uint32_t tile, uint32_t first, uint32_t count,
              const std::atomic<bool>& stop, const SampleOf& sample) {
  const uint32_t tiles_across = (film.width + tile_size - 1) / tile_size;
  const uint32_t left = (tile % tiles_across) * tile_size;
  const uint32_t top = (tile / tiles_across) * tile_size;
  const uint32_t right = std::min(left + tile_size, film.width);
  const uint32_t bottom = std::min(top + tile_size, film.height);

  PartialFilm sums(tile_size * tile_size, replicates, film.channels);
  for (uint32_t y = top; y < bottom; ++y) {
    for (uint32_t x = left; x < right; ++x) {
      const uint32_t pixel = (y - top) * tile_size + (x - left);
      for (uint32_t i = first; i < first + count; ++i) {
        if (stop) return false;
        sums.add(pixel, i % replicates, sample(x, y, i));
      }
    }
  }
  for (uint32_t y = top; y < bottom; ++y) {
    for (uint32_t x = left; x < right; ++x) {
      sums.flush((y - top) * tile_size + (x - left), film, static_cast<uint64_t>(y) * film.width + x);
    }
  }
  return true;
}

}  // namespace accuray
