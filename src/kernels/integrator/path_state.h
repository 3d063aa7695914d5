// A path as an explicit state: what its steps read and write, and nothing else lives between them.
#pragma once

#include "kernels/bsdf/bsdf.h"
#include "kernels/integrator/interior.h"
#include "kernels/light/light.h"
#include "kernels/sampling/sobol.h"
#include "kernels/spectrum/sensor.h"

namespace accuray {

struct Path {
  Ray ray;  // the ray to follow next
  Hit hit;  // what it met
  Wavelengths wl;
  Spectrum throughput;  // product of the weights so far
  Spectrum radiance;    // what the path has gathered
  Sampler sampler;
  Vec3 origin;         // the vertex that the ray leaves, before it was moved off its surface
  Vec3 origin_normal;  // shading normal there; zero at the camera
  float bsdf_pdf;      // density of the ray's direction; 0 after a delta lobe or at the camera
  float eta_scale;     // (eta now / eta at the camera)^2: radiance scaling, kept out of the roulette
  float alpha;         // 1 where the camera saw something
  uint32_t depth;      // scattering events so far
  uint32_t spent;      // of the weighted depth budget
  Interiors inside;    // the bodies that the ray is in
  bool alive;
};

// Sets of the sampler: two for the camera, two for each vertex.
constexpr uint32_t camera_set = 0;
constexpr uint32_t lens_set = 1;
inline uint32_t direction_set(const Path& path) { return 2u + 2u * path.depth; }
inline uint32_t decision_set(const Path& path) { return 3u + 2u * path.depth; }

inline Path start_path(const Ray& ray, const Wavelengths& wl, const Sampler& sampler) {
  return {ray, Hit{}, wl, lanes(1.0f), lanes(0.0f), sampler, ray.origin, {0, 0, 0}, 0.0f, 1.0f, 1.0f, 0, 0, {}, true};
}

}  // namespace accuray
