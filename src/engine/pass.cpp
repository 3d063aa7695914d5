#include "engine/pass.h"

#include <xmmintrin.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace accuray {

namespace {

// Denormals count as zero in every thread that renders: Embree asks for it, and the bits must not depend on who calls.
void set_float_mode() { _mm_setcsr(_mm_getcsr() | 0x8040u); }

// Sums of one pixel's samples.
struct PixelSums {
  int64_t value[16][film_channels];
  uint32_t dropped[16];
};

void add_sample(PixelSums& sums, uint32_t replicate, const Quantized& sample) {
  if (!sample.finite) {
    ++sums.dropped[replicate];
    return;
  }
  for (uint32_t c = 0; c < film_channels; ++c) {
    if (!add_checked(sums.value[replicate][c], sample.value[c])) {
      throw FilmOverflow("a pixel's sum no longer fits 64 bits: choose a larger film unit");
    }
  }
}

void add_pixel(const FilmView& film, uint64_t pixel, uint32_t replicates, const PixelSums& sums) {
  for (uint32_t r = 0; r < replicates; ++r) {
    int64_t* target = film.sums + (pixel * replicates + r) * film_channels;
    for (uint32_t c = 0; c < film_channels; ++c) {
      if (!add_checked(target[c], sums.value[r][c])) {
        throw FilmOverflow("a pixel's sum no longer fits 64 bits: choose a larger film unit");
      }
    }
    film.dropped[pixel * replicates + r] += sums.dropped[r];
  }
}

}  // namespace

Pool::Pool(const EmbreeScene& scene, uint32_t tasks, uint32_t threads, Task task)
    : scene_(scene), tasks_(tasks), task_(std::move(task)), running_(std::max(1u, std::min(threads, tasks))) {
  const uint32_t count = running_;
  for (uint32_t i = 0; i < count; ++i) threads_.emplace_back([this] { work(); });
}

Pool::~Pool() {
  stop();
  for (std::thread& thread : threads_) thread.join();
}

void Pool::work() {
  set_float_mode();
  try {
    while (!stopping_) {
      const uint32_t i = next_++;
      if (i >= tasks_) break;
      const EmbreeAccel accel(scene_);
      if (task_(i, accel, stopping_)) ++done_;
      rays_ += accel.rays();
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = std::current_exception();
    stopping_ = true;
  }
  const std::lock_guard lock(mutex_);
  if (--running_ == 0) ended_.notify_all();
}

bool Pool::wait(double seconds) {
  std::unique_lock lock(mutex_);
  const bool ended = ended_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return running_ == 0; });
  if (ended && error_) std::rethrow_exception(std::exchange(error_, nullptr));
  return ended;
}

bool render_tile(const SceneView& scene, const EmbreeAccel& accel, const Request& request, const FilmView& film,
                 uint32_t tile, uint32_t first, uint32_t count, const std::atomic<bool>& stop) {
  const uint32_t tiles_across = (film.width + tile_size - 1) / tile_size;
  const uint32_t left = (tile % tiles_across) * tile_size;
  const uint32_t top = (tile / tiles_across) * tile_size;
  const uint32_t right = std::min(left + tile_size, film.width);
  const uint32_t bottom = std::min(top + tile_size, film.height);
  const float inverse_step = 1.0f / scene.root->film_step;

  std::vector<PixelSums> sums(static_cast<size_t>(tile_size) * tile_size);
  for (uint32_t y = top; y < bottom; ++y) {
    for (uint32_t x = left; x < right; ++x) {
      PixelSums& pixel = sums[(y - top) * tile_size + (x - left)];
      for (uint32_t i = first; i < first + count; ++i) {
        const Quantized sample = sample_pixel(scene, accel, request, film.x0 + x, film.y0 + y, i, inverse_step);
        add_sample(pixel, i % request.replicates, sample);
      }
      if (stop) return false;
    }
  }
  for (uint32_t y = top; y < bottom; ++y) {
    for (uint32_t x = left; x < right; ++x) {
      add_pixel(film, static_cast<uint64_t>(y) * film.width + x, request.replicates, sums[(y - top) * tile_size + (x - left)]);
    }
  }
  return true;
}

bool trace_rays(const SceneView& scene, const EmbreeAccel& accel, const Request& request, const float* origins,
                const float* directions, const FilmView& film, uint32_t begin, uint32_t end, uint32_t first,
                uint32_t count, const std::atomic<bool>& stop) {
  const float inverse_step = 1.0f / scene.root->film_step;
  for (uint32_t ray = begin; ray < end; ++ray) {
    const Vec3 origin = load_vec3(origins, ray);
    const Vec3 direction = load_vec3(directions, ray);
    PixelSums sums{};
    for (uint32_t i = first; i < first + count; ++i) {
      if (stop) return false;
      add_sample(sums, i % request.replicates, sample_ray(scene, accel, request, origin, direction, ray, i, inverse_step));
    }
    add_pixel(film, ray, request.replicates, sums);
  }
  return true;
}

}  // namespace accuray
