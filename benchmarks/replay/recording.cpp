#include "replay/recording.h"

#include <algorithm>
#include <numeric>

namespace accuray::bench {

namespace {

// Passes every ray on to Embree and writes it down.
class RecordingAccel {
 public:
  RecordingAccel(const EmbreeAccel& inner, Chunk& rays) : inner_(&inner), rays_(&rays) {}

  Hit closest(const Ray& ray) const {
    const Hit hit = inner_->closest(ray);
    add(ray, false, answer_of(hit));
    return hit;
  }
  float transmittance(const Ray& ray) const {
    const float share = inner_->transmittance(ray);
    add(ray, true, answer_of(share));
    return share;
  }

 private:
  void add(const Ray& ray, bool shadow, uint32_t answer) const {
    rays_->push_back({{ray.origin.x, ray.origin.y, ray.origin.z},
                      {ray.direction.x, ray.direction.y, ray.direction.z},
                      ray.far,
                      shadow ? 1u : 0u,
                      answer & 0x7fffffffu});
  }

  const EmbreeAccel* inner_;
  Chunk* rays_;
};

static_assert(Accel<RecordingAccel>);

uint32_t tiles_across(const Request& request) { return (request.width + tile_size - 1) / tile_size; }
uint32_t tile_count(const Request& request) {
  return tiles_across(request) * ((request.height + tile_size - 1) / tile_size);
}

// Renders one tile as render_tile does, and returns the sum of its samples.
uint64_t record_tile(const SceneView& scene, const RecordingAccel& accel, const Request& request, uint32_t tile,
                     uint32_t spp) {
  const uint32_t left = (tile % tiles_across(request)) * tile_size;
  const uint32_t top = (tile / tiles_across(request)) * tile_size;
  uint64_t sum = 0;
  for (uint32_t y = top; y < std::min(top + tile_size, request.height); ++y) {
    for (uint32_t x = left; x < std::min(left + tile_size, request.width); ++x) {
      for (uint32_t i = 0; i < spp; ++i) {
        const Quantized sample = sample_pixel(scene, accel, request, x, y, i, 1.0f / scene.root->film_step);
        if (!sample.finite) continue;
        for (const int64_t value : sample.value) sum += static_cast<uint64_t>(value);
      }
    }
  }
  return sum;
}

void count(Recording& recording) {
  for (const Chunk& chunk : recording.tiles) {
    for (const RecordedRay& ray : chunk) {
      (ray.shadow ? recording.shadow : recording.closest) += 1;
      if (ray.shadow) {
        recording.blocked += ray.answer;
      } else {
        recording.hits += ray.answer != nothing_hit ? 1 : 0;
      }
    }
  }
}

}  // namespace

Recording record(const EmbreeScene& scene, const Request& request, uint32_t spp, uint32_t threads) {
  Recording recording;
  recording.tiles.resize(tile_count(request));
  std::atomic<uint64_t> sum{0};
  auto task = [&](uint32_t tile, const EmbreeAccel& accel, const std::atomic<bool>&) {
    sum += record_tile(scene.view(), RecordingAccel(accel, recording.tiles[tile]), request, tile, spp);
    recording.tiles[tile].shrink_to_fit();
    return true;
  };
  Pool pool(scene, tile_count(request), threads, task);
  while (!pool.wait(1.0)) {
  }
  recording.film_sum = sum;
  count(recording);
  return recording;
}

uint64_t render(const EmbreeScene& scene, const Request& request, uint32_t spp, uint32_t threads) {
  const size_t slots = size_t{request.width} * request.height * request.replicates;
  std::vector<int64_t> sums(slots * film_channels);
  std::vector<uint32_t> dropped(slots);
  const FilmView film{sums.data(), dropped.data(), 0, 0, request.width, request.height, film_channels};
  auto task = [&](uint32_t tile, const EmbreeAccel& accel, const std::atomic<bool>& stop) {
    return render_tile(scene.view(), accel, request, film, tile, 0, spp, stop);
  };
  Pool pool(scene, tile_count(request), threads, task);
  while (!pool.wait(1.0)) {
  }
  return std::accumulate(sums.begin(), sums.end(), uint64_t{0},
                         [](uint64_t total, int64_t value) { return total + static_cast<uint64_t>(value); });
}

}  // namespace accuray::bench
