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
  Vec3 origin_normal;  // of the side that gathers light there; zero: both, or the camera
  float bsdf_pdf;      // density of the ray's direction; 0 after a delta lobe or at the camera
  float eta_scale;     // (eta now / eta at the camera)^2: radiance scaling, kept out of the roulette
  uint32_t depth;      // scattering events so far
  uint32_t spent;      // of the weighted depth budget
  Interiors inside;    // the bodies that the ray is in
  bool alive;
  bool seen;  // by the camera: something, so that the sample counts as covered
  Cone cone;  // around the ray, from `origin`; only for scenes with mipmaps
};

// Sets of the sampler: two for the camera, two for each vertex.
constexpr uint32_t camera_set = 0;
constexpr uint32_t lens_set = 1;
inline uint32_t direction_set(const Path& path) { return 2u + 2u * path.depth; }
inline uint32_t decision_set(const Path& path) { return 3u + 2u * path.depth; }

inline float alpha_of(const Path& path) { return path.seen ? 1.0f : 0.0f; }

inline Path start_path(const Ray& ray, const Wavelengths& wl, const Sampler& sampler) {
  return {ray,  Hit{}, wl, lanes(1.0f), lanes(0.0f), sampler, ray.origin, {0, 0, 0},
          0.0f, 1.0f,  0,  0,           {},          true,    true,       {}};
}

// What a scattered direction stands for: a cone of a sixteenth of its lobe's solid angle, taken as 1/pdf. A lobe thus
// counts as sampled by sixteen directions (after Suykens and Willems 2001, "Path Differentials and Applications").
inline float lobe_spread(float pdf) { return min(0.5f / sqrt(pi * pdf), 1.0f); }

// Step widen: the path's cone at a vertex, from which it goes on along a direction of this density. Mirrors and smooth
// glass, of pdf 0, keep it as it is: what their curvature adds is left out, which errs on the sharp side.
inline void widen_cone(Vec3 vertex, float pdf, Path& path) {
  if (path.cone.is_ray()) return;
  path.cone.width = path.cone.width_after(length(vertex - path.origin));
  if (pdf > 0.0f) path.cone.spread += lobe_spread(pdf);
}

// Diameter of the path's cone on a surface that it meets (Akenine-Moller et al. 2021, "Improved Shader and Texture
// Level of Detail Using Ray Cones").
inline float footprint_on(const Surface& surface, const Path& path) {
  if (path.cone.is_ray()) return 0.0f;
  const float cosine = abs(dot(path.ray.direction, surface.normal));
  return path.cone.width_after(length(surface.point - path.origin)) / max(cosine, 1e-4f);
}

}  // namespace accuray
