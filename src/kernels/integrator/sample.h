// One sample of one pixel, or of one probe ray: the pure function of (scene, seed, pixel, index) that everything adds
// up.
#pragma once

#include "kernels/camera/list.h"
#include "kernels/film/filter.h"
#include "kernels/film/quantize.h"
#include "kernels/film/shutter.h"
#include "kernels/geometry/motion.h"
#include "kernels/integrator/list.h"

namespace accuray {

// What a rendering asks for besides the scene.
struct Request {
  Observer observer;
  uint32_t seed;
  uint32_t replicates;
  uint32_t width, height;  // of the whole picture
};

// Every pixel and replicate has a scramble of its own; the replicate takes turns with the sample number.
inline uint32_t pixel_key(const Request& request, uint32_t x, uint32_t y, uint32_t index) {
  return hash(request.seed, x, y, index % request.replicates);
}
inline Sampler sampler_for(const Request& request, uint32_t key, uint32_t index) {
  return Sampler::at(key, index / request.replicates);
}
inline uint32_t dither_key(uint32_t key, uint32_t index) { return hash(key, index, 0x64697468u); }

// The scene's camera at a point of the film.
inline CameraRay camera_ray(const SceneView& scene, Vec2 film, const Sampler& sampler, float time) {
  CameraRay seen = dispatch(Cameras{}, scene.root->camera.tag, [&](auto type) {
    using Camera = typename decltype(type)::type;
    const f32x4 u_lens = Camera::has_lens ? sampler.draw(lens_set) : lanes(0.5f);
    return scene.as<Camera>(scene.root->camera).ray(film, {u_lens[0], u_lens[1]}, time);
  });
  if (scene.root->camera_motion != none) [[unlikely]]
    seen.ray = carried_by(scene, scene.root->camera_motion, seen.ray);
  return seen;
}

// The cone around a camera ray that covers a pixel, from how far the rays through the neighbouring pixels are, by the
// same point of the lens. The neighbours are those towards the middle of the film, which any camera sees.
ACCURAY_NOINLINE inline Cone pixel_cone(const SceneView& scene, const Request& request, Vec2 film, Sampler sampler,
                                        Ray ray) {
  const float right = (film.x < 0.5f ? 1.0f : -1.0f) / static_cast<float>(request.width);
  const float down = (film.y < 0.5f ? 1.0f : -1.0f) / static_cast<float>(request.height);
  const Ray beside = camera_ray(scene, {film.x + right, film.y}, sampler, ray.time).ray;
  const Ray below = camera_ray(scene, {film.x, film.y + down}, sampler, ray.time).ray;
  return {0.5f * (length(beside.origin - ray.origin) + length(below.origin - ray.origin)),
          0.5f * (length(beside.direction - ray.direction) + length(below.direction - ray.direction))};
}

// Step generate: a camera path through pixel (x, y).
inline Path generate(const SceneView& scene, const Request& request, uint32_t x, uint32_t y, const Sampler& sampler,
                     const Wavelengths& wl, f32x4 u) {
  const Vec2 offset = dispatch(Filters{}, scene.root->filter.tag, [&](auto type) {
    const auto& filter = scene.as<typename decltype(type)::type>(scene.root->filter);
    return Vec2{filter.sample(u[0]), filter.sample(u[1])};
  });
  const Vec2 film = {(static_cast<float>(x) + 0.5f + offset.x) / static_cast<float>(request.width),
                     (static_cast<float>(y) + 0.5f + offset.y) / static_cast<float>(request.height)};
  const float time = path_time(scene, u[3]);
  const CameraRay seen = camera_ray(scene, film, sampler, time);
  Path path = start_path(seen.ray, wl, sampler);
  if (scene.root->any_mipmap != 0) [[unlikely]]
    path.cone = pixel_cone(scene, request, film, sampler, seen.ray);
  if (!seen.seen) {
    path.alive = false;
    path.seen = false;
  }
  return path;
}

// `Among`: the integrators that may be asked for. A kernel for GPUs has one, which is what its threads' memory bears.
template <class Among, Accel A>
inline void trace(const SceneView& scene, const A& accel, Path& path) {
  dispatch(Among{}, scene.root->integrator.tag, [&](auto type) {
    scene.as<typename decltype(type)::type>(scene.root->integrator).trace(scene, accel, path);
    return true;
  });
}

// Emission and direct light of the path that `trace` follows from the same start.
template <Accel A>
inline void trace_direct(const SceneView& scene, const A& accel, Path& path) {
  dispatch(Integrators{}, scene.root->integrator.tag, [&](auto type) {
    scene.as<typename decltype(type)::type>(scene.root->integrator).direct_part().trace(scene, accel, path);
    return true;
  });
}

// Sample `index` of pixel (x, y), rounded to the film's step.
template <class Among = Integrators, Accel A>
inline Quantized sample_pixel(const SceneView& scene, const A& accel, const Request& request, uint32_t x, uint32_t y,
                              uint32_t index, float inverse_step) {
  const uint32_t key = pixel_key(request, x, y, index);
  const Sampler sampler = sampler_for(request, key, index);
  const f32x4 u = sampler.draw(camera_set);
  Path path = generate(scene, request, x, y, sampler, sample_wavelengths(scene, request.observer, u[2]), u);
  trace<Among>(scene, accel, path);
  const f32x4 channels = respond(scene, request.observer, path.wl, path.radiance, alpha_of(path), u[2]);
  return quantize(channels, inverse_step, dither_key(key, index));
}

// The same sample with its indirect light beside it: what was scattered more than once on its way to the camera.
struct LayeredSample {
  Quantized picture;   // what sample_pixel gives
  Quantized indirect;  // X, Y, Z, 0
};

// The path is traced again as far as its first event. Both add the same numbers in the same order up to there, so that
// the difference is what the whole path gathered later: never negative, and zero where it ended.
template <Accel A>
inline LayeredSample sample_pixel_layers(const SceneView& scene, const A& accel, const Request& request, uint32_t x,
                                         uint32_t y, uint32_t index, float inverse_step) {
  const uint32_t key = pixel_key(request, x, y, index);
  const Sampler sampler = sampler_for(request, key, index);
  const f32x4 u = sampler.draw(camera_set);
  Path path = generate(scene, request, x, y, sampler, sample_wavelengths(scene, request.observer, u[2]), u);
  Path direct = path;
  trace<Integrators>(scene, accel, path);
  trace_direct(scene, accel, direct);
  const f32x4 channels = respond(scene, request.observer, path.wl, path.radiance, alpha_of(path), u[2]);
  const f32x4 indirect = respond(scene, request.observer, path.wl, path.radiance - direct.radiance, 0.0f, u[2]);
  const uint32_t dither = dither_key(key, index);
  return {quantize(channels, inverse_step, dither), quantize(indirect, inverse_step, hash(dither, 0x696e6469u))};
}

// What sample_pixel gives, along a given ray; `number` takes the pixel's place.
template <Accel A>
inline Quantized sample_ray(const SceneView& scene, const A& accel, const Request& request, Vec3 origin, Vec3 direction,
                            uint32_t number, uint32_t index, float inverse_step) {
  const uint32_t key = pixel_key(request, number, 0xffffffffu, index);
  const Sampler sampler = sampler_for(request, key, index);
  const f32x4 u = sampler.draw(camera_set);
  Path path = start_path({origin, direction, infinity, path_time(scene, u[3])},
                         sample_wavelengths(scene, request.observer, u[2]), sampler);
  trace<Integrators>(scene, accel, path);
  const f32x4 channels = respond(scene, request.observer, path.wl, path.radiance, alpha_of(path), u[2]);
  return quantize(channels, inverse_step, dither_key(key, index));
}

}  // namespace accuray
