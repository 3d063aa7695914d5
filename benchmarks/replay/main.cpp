// How long a rendering takes beside the bare loops that trace the very same rays (design, 5.7).
//
//   accuray_replay BLOCK WIDTH HEIGHT SPP SEED REPLICATES THREADS REPEATS
//
// BLOCK is a lowered scene (see block_file.h). Prints one JSON object. Exit status 1: the recorded and the rendered
// samples differ, a ray's answer differs when AccuRay's intersector traces it again, or a loop met clearly other
// things.
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <numeric>
#include <string>

#include "replay/bare_scene.h"
#include "replay/block_file.h"
#include "replay/loops.h"
#include "replay/recording.h"

namespace accuray::bench {

namespace {

constexpr const char* kOurDevice = "isa=avx2,frequency_level=simd256";
constexpr const char* kWidestDevice = "";
// Packets and other instruction sets round differently: so large a share of the rays may meet something else.
constexpr double kTolerance = 1e-4;

struct Timing {
  std::vector<double> wall, cpu;
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void measure(Timing& timing, const std::function<void()>& work) {
  const auto started = std::chrono::steady_clock::now();
  const double cpu = cpu_seconds();
  work();
  timing.cpu.push_back(cpu_seconds() - cpu);
  timing.wall.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count());
}

// Sums work(i) over i = 0 ... count-1; threads take what comes next. Denormals count as zero, as in the engine.
template <class Result>
Result parallel(uint32_t threads, size_t count, const std::function<Result(size_t)>& work) {
  std::atomic<size_t> next{0};
  std::vector<Result> results(threads);
  std::vector<std::thread> pool;
  for (uint32_t t = 0; t < threads; ++t) {
    pool.emplace_back([&, t] {
      _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
      _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
      Result result{};
      for (size_t i = next++; i < count; i = next++) result += work(i);
      results[t] = result;
    });
  }
  for (std::thread& thread : pool) thread.join();
  Result total{};
  for (const Result& result : results) total += result;
  return total;
}

// The same rays in the layouts that the loops read; making them takes none of the loops' time.
struct Rays {
  std::vector<Chunk> recorded, by_place;
  std::vector<std::vector<Packet<8>>> eights, eights_by_place;
  std::vector<std::vector<Packet<16>>> sixteens;

  explicit Rays(std::vector<Chunk> tiles) : recorded(std::move(tiles)) {
    for (const Chunk& chunk : recorded) {
      by_place.push_back(sorted(chunk));
      eights.push_back(pack<8>(chunk));
      eights_by_place.push_back(pack<8>(by_place.back()));
      sixteens.push_back(pack<16>(chunk));
    }
  }
};

struct Scenes {
  EmbreeScene ours;
  BareScene roomy, widest, careless, high;

  explicit Scenes(const SceneView& view)
      : ours(view),
        roomy(view, {kOurDevice, true, false, RTC_BUILD_QUALITY_MEDIUM}),
        widest(view, {kWidestDevice, true, false, RTC_BUILD_QUALITY_MEDIUM}),
        careless(view, {kWidestDevice, false, false, RTC_BUILD_QUALITY_MEDIUM}),
        high(view, {kWidestDevice, true, false, RTC_BUILD_QUALITY_HIGH}) {}
};

struct Loop {
  const char* name;
  bool counts;  // bare Embree, robust and in recorded order: what a renderer could do
  std::function<Tally(size_t)> trace;
  Timing timing{};
  Tally tally{};
};

std::vector<Loop> loops_over(const Scenes& scenes, const Rays& rays) {
  const auto single = [](const BareScene& scene, const std::vector<Chunk>& chunks) {
    return [&scene, &chunks](size_t i) { return trace_single(scene.scene(), chunks[i]); };
  };
  const auto packets = [](const BareScene& scene, const auto& chunks) {
    return [&scene, &chunks](size_t i) { return trace_packets(scene.scene(), std::span(chunks[i])); };
  };
  return {
      {"single rays, AccuRay's own intersector", false,
       [&](size_t i) { return trace_own(EmbreeAccel(scenes.ours), rays.recorded[i]); }},
      {"single rays, avx2", true, single(scenes.roomy, rays.recorded)},
      {"packets of 8, avx2", true, packets(scenes.roomy, rays.eights)},
      {"single rays, widest instructions", true, single(scenes.widest, rays.recorded)},
      {"packets of 8, widest instructions", true, packets(scenes.widest, rays.eights)},
      {"packets of 16, widest instructions", true, packets(scenes.widest, rays.sixteens)},
      {"single rays, widest instructions, high quality", true, single(scenes.high, rays.recorded)},
      {"single rays, widest instructions, not robust", false, single(scenes.careless, rays.recorded)},
      {"packets of 8, widest instructions, not robust", false, packets(scenes.careless, rays.eights)},
      {"single rays, avx2, sorted by direction and place", false, single(scenes.roomy, rays.by_place)},
      {"packets of 8, avx2, sorted by direction and place", false, packets(scenes.roomy, rays.eights_by_place)},
  };
}

bool agrees(const Recording& recording, const Tally& tally) {
  const auto apart = [](uint64_t a, uint64_t b) { return static_cast<double>(a > b ? a - b : b - a); };
  return apart(recording.hits, tally.hits) + apart(recording.blocked, tally.blocked) <=
         kTolerance * static_cast<double>(recording.rays());
}

void print_timing(const Timing& timing) {
  std::printf("\"seconds\": %.6g, \"cpu_s\": %.6g", median(timing.wall), median(timing.cpu));
}

int replay(const std::string& path, const Request& request, uint32_t spp, uint32_t threads, uint32_t repeats) {
  const Block block = load_block(path);
  const SceneView view = block.view();
  const Scenes scenes(view);
  Recording recording = record(scenes.ours, request, spp, threads);
  const Rays rays(std::move(recording.tiles));
  const uint64_t mismatches = parallel<uint64_t>(threads, rays.recorded.size(), [&](size_t i) {
    return count_mismatches(EmbreeAccel(scenes.ours), rays.recorded[i]);
  });
  bool good = mismatches == 0;

  Timing rendering;
  std::vector<Loop> loops = loops_over(scenes, rays);
  for (uint32_t repeat = 0; repeat < repeats; ++repeat) {
    measure(rendering, [&] { good &= render(scenes.ours, request, spp, threads) == recording.film_sum; });
    for (Loop& loop : loops) {
      measure(loop.timing, [&] { loop.tally = parallel<Tally>(threads, rays.recorded.size(), loop.trace); });
      good &= agrees(recording, loop.tally);
    }
  }

  std::printf(
      "{\"samples\": %llu, \"closest\": %llu, \"shadow\": %llu, \"mismatches\": %llu, \"good\": %s, \"render\": {",
      static_cast<unsigned long long>(request.width) * request.height * spp,
      static_cast<unsigned long long>(recording.closest), static_cast<unsigned long long>(recording.shadow),
      static_cast<unsigned long long>(mismatches), good ? "true" : "false");
  print_timing(rendering);
  std::printf("}, \"loops\": [");
  for (const Loop& loop : loops) {
    std::printf("%s{\"name\": \"%s\", \"counts\": %s, ", &loop == loops.data() ? "" : ", ", loop.name,
                loop.counts ? "true" : "false");
    print_timing(loop.timing);
    std::printf("}");
  }
  std::printf("]}\n");
  return good ? 0 : 1;
}

uint32_t number(const char* text) {
  char* end = nullptr;
  const unsigned long value = std::strtoul(text, &end, 10);
  if (*end != '\0' || value == 0 || value > 0xffffffff) throw std::runtime_error(std::string(text) + " is no number");
  return static_cast<uint32_t>(value);
}

}  // namespace

}  // namespace accuray::bench

int main(int count, char** arguments) {
  using namespace accuray;
  if (count != 9) {
    std::fprintf(stderr, "usage: accuray_replay BLOCK WIDTH HEIGHT SPP SEED REPLICATES THREADS REPEATS\n");
    return 2;
  }
  try {
    Request request{};
    request.width = bench::number(arguments[2]);
    request.height = bench::number(arguments[3]);
    request.seed = bench::number(arguments[5]);
    request.replicates = bench::number(arguments[6]);
    return bench::replay(arguments[1], request, bench::number(arguments[4]), bench::number(arguments[7]),
                         bench::number(arguments[8]));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "accuray_replay: %s\n", error.what());
    return 2;
  }
}
