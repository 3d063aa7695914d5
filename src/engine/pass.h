// A pass: some samples of some pixels, rendered by a pool of threads that can be asked to stop at any moment.
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "engine/embree_accel.h"
#include "kernels/integrator/sample.h"

namespace accuray {

// Runs task(i, accel) for i = 0 ... count-1 on some threads, in any order, each exactly once; a task returns false if
// it gave up because `stop` turned true. Tasks must write to disjoint places.
class Pool {
 public:
  using Task = std::function<bool(uint32_t, const EmbreeAccel&, const std::atomic<bool>& stop)>;

  Pool(const EmbreeScene& scene, uint32_t tasks, uint32_t threads, Task task);
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  // True once all threads have ended; waits at most `seconds`. Throws what a task has thrown.
  bool wait(double seconds);
  void stop() { stopping_ = true; }
  bool stopping() const { return stopping_; }
  uint32_t done() const { return done_; }
  uint64_t rays() const { return rays_; }

 private:
  void work();

  const EmbreeScene& scene_;
  const uint32_t tasks_;
  const Task task_;
  std::atomic<uint32_t> next_{0}, done_{0};
  std::atomic<uint64_t> rays_{0};
  std::atomic<bool> stopping_{false};
  std::mutex mutex_;
  std::condition_variable ended_;
  uint32_t running_;
  std::exception_ptr error_;
  std::vector<std::thread> threads_;
};

// Where the sums of a picture lie. Pixel (x, y) of the window, replicate r, channel c: sums[((y * width + x) * R + r) *
// channels + c].
struct FilmView {
  int64_t* sums;
  uint32_t* dropped;       // per pixel and replicate
  uint32_t x0, y0;         // the window's corner in the whole picture
  uint32_t width, height;  // of the window
  uint32_t channels;       // film_channels, and layer_channels more with indirect light
};

struct FilmOverflow : std::runtime_error {
  using std::runtime_error::runtime_error;
};

constexpr uint32_t tile_size = 16;

// Adds samples [first, first + count) of every pixel of one tile to the film; false, and the film untouched, if `stop`
// turned true meanwhile. Throws FilmOverflow if a sum would leave 64 bits.
bool render_tile(const SceneView& scene, const EmbreeAccel& accel, const Request& request, const FilmView& film,
                 uint32_t tile, uint32_t first, uint32_t count, const std::atomic<bool>& stop);

// The same with indirect light.
bool render_tile_layers(const SceneView& scene, const EmbreeAccel& accel, const Request& request, const FilmView& film,
                        uint32_t tile, uint32_t first, uint32_t count, const std::atomic<bool>& stop);

// The same as render_tile for rays [begin, end) of a list; sums are laid out as for a picture of height 1.
bool trace_rays(const SceneView& scene, const EmbreeAccel& accel, const Request& request, const float* origins,
                const float* directions, const FilmView& film, uint32_t begin, uint32_t end, uint32_t first,
                uint32_t count, const std::atomic<bool>& stop);

}  // namespace accuray
