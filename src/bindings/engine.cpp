// Rendering: scenes on this machine, and passes over pixels or rays.
#include "bindings/bindings.h"
#include "bindings/loaded_scene.h"
#include "engine/pass.h"

namespace accuray::bindings {

namespace {

using Sums = nb::ndarray<int64_t, nb::ndim<4>, nb::c_contig, nb::device::cpu>;
using Dropped = nb::ndarray<uint32_t, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

Request to_request(uint32_t seed, uint32_t replicates, uint32_t width, uint32_t height,
                   const std::vector<float>& wavelengths) {
  if (replicates < 1 || replicates > 16) throw std::invalid_argument("replicates must be 1 to 16");
  Request request{};
  request.seed = seed;
  request.replicates = replicates;
  request.width = width;
  request.height = height;
  if (!wavelengths.empty()) {
    if (wavelengths.size() > 4) throw std::invalid_argument("at most four wavelengths at a time");
    request.observer.fixed = 1;
    for (size_t k = 0; k < 4; ++k)
      request.observer.lambda[static_cast<int>(k)] = wavelengths[std::min(k, wavelengths.size() - 1)];
  }
  return request;
}

FilmView to_film(const Sums& sums, const Dropped& dropped, uint32_t x0, uint32_t y0, uint32_t replicates) {
  const bool known = sums.shape(3) == film_channels || sums.shape(3) == film_channels + layer_channels;
  if (sums.shape(2) != replicates || !known || dropped.shape(0) != sums.shape(0) || dropped.shape(1) != sums.shape(1) ||
      dropped.shape(2) != replicates) {
    throw std::invalid_argument("sums must be (H, W, replicates, 4 or 7) and dropped (H, W, replicates)");
  }
  const auto size = [&](size_t axis) { return static_cast<uint32_t>(sums.shape(axis)); };
  return {sums.data(), dropped.data(), x0, y0, size(1), size(0), size(3)};
}

// A running pass; keeps everything that its threads read and write alive.
struct Pass {
  std::shared_ptr<LoadedScene> scene;
  Sums sums;
  Dropped dropped;
  std::vector<float> origins, directions;
  std::vector<uint8_t> finished;  // per task, in the order of the tasks' numbers
  std::unique_ptr<Pool> pool;

  bool wait(double seconds) {
    const nb::gil_scoped_release release;
    return pool->wait(seconds);
  }
  // Joining must not hold the GIL while the threads finish their samples.
  ~Pass() {
    if (!pool) return;
    const nb::gil_scoped_release release;
    pool.reset();
  }
};

std::unique_ptr<Pass> render_pass(std::shared_ptr<LoadedScene> scene, Sums sums, Dropped dropped, uint32_t x0,
                                  uint32_t y0, uint32_t width, uint32_t height, const std::vector<uint32_t>& tiles,
                                  uint64_t first, uint32_t count, uint32_t seed, uint32_t replicates,
                                  uint32_t threads) {
  if (first + count > 0xffffffffull) throw std::invalid_argument("sample numbers must stay below 2^32");
  auto pass = std::make_unique<Pass>();
  const FilmView film = to_film(sums, dropped, x0, y0, replicates);
  const Request request = to_request(seed, replicates, width, height, {});
  const uint32_t all = ((film.width + tile_size - 1) / tile_size) * ((film.height + tile_size - 1) / tile_size);
  for (const uint32_t tile : tiles) {
    if (tile >= all) throw std::invalid_argument("there is no tile " + std::to_string(tile));
  }
  pass->scene = std::move(scene);
  pass->sums = std::move(sums);
  pass->dropped = std::move(dropped);
  pass->finished.assign(tiles.size(), 0);
  pass->pool = nullptr;
  Pass* p = pass.get();
  auto task = [p, film, request, tiles, first, count](uint32_t i, const EmbreeAccel& accel,
                                                      const std::atomic<bool>& stop) {
    const SceneView& view = p->scene->view;
    const auto render = film.channels == film_channels ? &render_tile : &render_tile_layers;
    const bool done = render(view, accel, request, film, tiles[i], static_cast<uint32_t>(first), count, stop);
    p->finished[i] = done ? 1 : 0;
    return done;
  };
  pass->pool = std::make_unique<Pool>(p->scene->accel, static_cast<uint32_t>(tiles.size()), threads, std::move(task));
  return pass;
}

constexpr uint32_t kRaysPerTask = 256;

std::unique_ptr<Pass> ray_pass(std::shared_ptr<LoadedScene> scene, Sums sums, Dropped dropped,
                               const Rows<float, 3>& origins, const Rows<float, 3>& directions, uint64_t first,
                               uint32_t count, uint32_t seed, uint32_t replicates, uint32_t threads,
                               const std::vector<float>& wavelengths) {
  if (origins.shape(0) != directions.shape(0))
    throw std::invalid_argument("there must be as many directions as origins");
  if (origins.shape(0) >= 0xffffffffull) throw std::invalid_argument("there are too many rays");
  if (first + count > 0xffffffffull) throw std::invalid_argument("sample numbers must stay below 2^32");
  auto pass = std::make_unique<Pass>();
  const FilmView film = to_film(sums, dropped, 0, 0, replicates);
  const Request request = to_request(seed, replicates, 1, 1, wavelengths);
  const auto rays = static_cast<uint32_t>(origins.shape(0));
  if (film.width != rays || film.height != 1 || film.channels != film_channels)
    throw std::invalid_argument("sums must have one row, a column for each ray and 4 channels");
  pass->scene = std::move(scene);
  pass->sums = std::move(sums);
  pass->dropped = std::move(dropped);
  pass->origins = to_vector(origins);
  pass->directions = to_vector(directions);
  const uint32_t tasks = (rays + kRaysPerTask - 1) / kRaysPerTask;
  pass->finished.assign(tasks, 0);
  Pass* p = pass.get();
  auto task = [p, film, request, rays, first, count](uint32_t i, const EmbreeAccel& accel,
                                                     const std::atomic<bool>& stop) {
    const bool done =
        trace_rays(p->scene->view, accel, request, p->origins.data(), p->directions.data(), film, i * kRaysPerTask,
                   std::min((i + 1) * kRaysPerTask, rays), static_cast<uint32_t>(first), count, stop);
    p->finished[i] = done ? 1 : 0;
    return done;
  };
  pass->pool = std::make_unique<Pool>(p->scene->accel, tasks, threads, std::move(task));
  return pass;
}

}  // namespace

void bind_engine(nb::module_& module) {
  nb::module_ engine = module.def_submodule("engine", "Rendering on this machine.");
  engine.attr("EMBREE_VERSION") = RTC_VERSION_STRING;
  engine.attr("ISA") = "x86-64-v3";
  engine.attr("TILE_SIZE") = tile_size;
  nb::exception<FilmOverflow>(engine, "FilmOverflow", PyExc_OverflowError);
  nb::exception<EmbreeError>(engine, "EmbreeError", PyExc_RuntimeError);
  nb::class_<LoadedScene>(engine, "LoadedScene")
      .def(
          "__init__",
          [](LoadedScene* self, const Block& block, const LoadedScene* before, bool same_shapes) {
            const nb::gil_scoped_release release;
            if (before != nullptr && same_shapes) {
              new (self) LoadedScene(LoadedScene::with_shapes_of(*before, block));
            } else {
              new (self) LoadedScene(block, before);
            }
          },
          "block"_a, "before"_a.none() = nullptr, "same_shapes"_a = false,
          "before: an earlier frame, parts of whose acceleration structure may serve; all of it with same_shapes, "
          "which "
          "says that the shapes are the same, bit for bit.")
      .def_prop_ro(
          "built_prototypes", [](const LoadedScene& scene) { return scene.accel.built_prototypes(); },
          "How many structures were made over what instances show.")
      .def_prop_ro(
          "structure", [](const LoadedScene& scene) { return reinterpret_cast<uintptr_t>(scene.shapes.get()); },
          "The same number for scenes that share their acceleration structure.")
      .def_prop_ro("accel_bytes", [](const LoadedScene& scene) { return scene.accel.bytes(); })
      .def_prop_ro("lights", [](const LoadedScene& scene) { return scene.view.root->lights.count; });
  nb::class_<Pass>(engine, "Pass")
      .def("wait", &Pass::wait, "seconds"_a, "True once the pass has ended; waits at most so long.")
      .def("stop", [](Pass& pass) { pass.pool->stop(); })
      .def_prop_ro(
          "done", [](const Pass& pass) { return pass.pool->done(); }, "Tasks that are finished.")
      .def_prop_ro("rays", [](const Pass& pass) { return pass.pool->rays(); })
      .def_prop_ro(
          "finished", [](const Pass& pass) { return to_numpy(std::vector<uint8_t>(pass.finished), 0); },
          "1 for each task that is finished; valid after the end.");
  engine.def("render_pass", &render_pass, "scene"_a, "sums"_a, "dropped"_a, "x0"_a, "y0"_a, "width"_a, "height"_a,
             "tiles"_a, "first"_a, "count"_a, "seed"_a, "replicates"_a, "threads"_a);
  engine.def("ray_pass", &ray_pass, "scene"_a, "sums"_a, "dropped"_a, "origins"_a, "directions"_a, "first"_a, "count"_a,
             "seed"_a, "replicates"_a, "threads"_a, "wavelengths"_a);
}

}  // namespace accuray::bindings
