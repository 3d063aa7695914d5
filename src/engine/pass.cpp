#include "engine/pass.h"

#include <xmmintrin.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace accuray {

namespace {

// Denormals count as zero in every thread that renders: Embree asks for it, and the bits must not depend on who calls.
void set_float_mode() { _mm_setcsr(_mm_getcsr() | 0x8040u); }

[[noreturn]] void throw_overflow() {
  throw FilmOverflow("a pixel's sum no longer fits 64 bits: choose a larger film unit");
}

// Sums of some pixels: by pixel, replicate and channel as in FilmView.
class PartialFilm {
 public:
  PartialFilm(uint32_t pixels, uint32_t replicates)
      : replicates_(replicates),
        sums_(static_cast<size_t>(pixels) * replicates * film_channels),
        dropped_(static_cast<size_t>(pixels) * replicates) {}

  void add(uint32_t pixel, uint32_t replicate, const Quantized& sample) {
    const size_t slot = static_cast<size_t>(pixel) * replicates_ + replicate;
    if (!sample.finite) {
      ++dropped_[slot];
      return;
    }
    bool fits = true;
    for (uint32_t c = 0; c < film_channels; ++c) fits &= add_checked(sums_[slot * film_channels + c], sample.value[c]);
    if (!fits) throw_overflow();
  }
  // Adds one of these pixels to a pixel of the film.
  void flush(uint32_t pixel, const FilmView& film, uint64_t target) const {
    for (uint32_t r = 0; r < replicates_; ++r) {
      const size_t slot = static_cast<size_t>(pixel) * replicates_ + r;
      const uint64_t film_slot = target * replicates_ + r;
      bool fits = true;
      for (uint32_t c = 0; c < film_channels; ++c) {
        fits &= add_checked(film.sums[film_slot * film_channels + c], sums_[slot * film_channels + c]);
      }
      if (!fits) throw_overflow();
      film.dropped[film_slot] += dropped_[slot];
    }
  }

 private:
  uint32_t replicates_;
  std::vector<int64_t> sums_;
  std::vector<uint32_t> dropped_;
};

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

  PartialFilm sums(tile_size * tile_size, request.replicates);
  for (uint32_t y = top; y < bottom; ++y) {
    for (uint32_t x = left; x < right; ++x) {
      const uint32_t pixel = (y - top) * tile_size + (x - left);
      for (uint32_t i = first; i < first + count; ++i) {
        if (stop) return false;
        sums.add(pixel, i % request.replicates,
                 sample_pixel(scene, accel, request, film.x0 + x, film.y0 + y, i, inverse_step));
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

bool trace_rays(const SceneView& scene, const EmbreeAccel& accel, const Request& request, const float* origins,
                const float* directions, const FilmView& film, uint32_t begin, uint32_t end, uint32_t first,
                uint32_t count, const std::atomic<bool>& stop) {
  const float inverse_step = 1.0f / scene.root->film_step;
  PartialFilm sums(end - begin, request.replicates);
  for (uint32_t ray = begin; ray < end; ++ray) {
    const Vec3 origin = load_vec3(origins, ray);
    const Vec3 direction = load_vec3(directions, ray);
    for (uint32_t i = first; i < first + count; ++i) {
      if (stop) return false;
      sums.add(ray - begin, i % request.replicates,
               sample_ray(scene, accel, request, origin, direction, ray, i, inverse_step));
    }
  }
  for (uint32_t ray = begin; ray < end; ++ray) sums.flush(ray - begin, film, ray);
  return true;
}

}  // namespace accuray
