// Tiles of a film that holds layers besides its colours: apart from the others, so that these are compiled as ever.
#include "engine/tile.h"

namespace accuray {

bool render_tile_layers(const SceneView& scene, const EmbreeAccel& accel, const Request& request, const FilmView& film,
                        uint32_t tile, uint32_t first, uint32_t count, const std::atomic<bool>& stop) {
  const float inverse_step = 1.0f / scene.root->film_step;
  return add_tile(film, request.replicates, tile, first, count, stop, [&](uint32_t x, uint32_t y, uint32_t i) {
    return sample_pixel_layers(scene, accel, request, film.x0 + x, film.y0 + y, i, inverse_step);
  });
}

}  // namespace accuray
