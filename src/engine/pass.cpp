#include "engine/pass.h"

#include <xmmintrin.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "engine/tile.h"

namespace accuray {

namespace {

// Denormals count as zero in every thread that renders: Embree asks for it, and the bits must not depend on who calls.
void set_float_mode() { _mm_setcsr(_mm_getcsr() | 0x8040u); }

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
  const float inverse_step = 1.0f / scene.root->film_step;
  return add_tile(film, request.replicates, tile, first, count, stop, [&](uint32_t x, uint32_t y, uint32_t i) {
    return sample_pixel(scene, accel, request, film.x0 + x, film.y0 + y, i, inverse_step);
  });
}

bool trace_rays(const SceneView& scene, const EmbreeAccel& accel, const Request& request, const float* origins,
                const float* directions, const FilmView& film, uint32_t begin, uint32_t end, uint32_t first,
                uint32_t count, const std::atomic<bool>& stop) {
  const float inverse_step = 1.0f / scene.root->film_step;
  PartialFilm sums(end - begin, request.replicates, film.channels);
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
