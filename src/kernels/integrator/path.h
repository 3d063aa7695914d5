// Unidirectional path tracing with next-event estimation and multiple importance sampling (Kajiya 1986; Veach 1997).
//
// A path x0 x1 x2 ... from the camera gathers at each vertex the light emitted there towards the previous one. Light
// that falls on a vertex straight from an emitter is estimated twice, by a point chosen on a light and by the direction
// chosen by the BSDF, and both are weighted so that their sum stays the light itself.
#pragma once

#include "kernels/integrator/miss.h"
#include "kernels/schema.h"

namespace accuray {

struct PathTracing {
  int32_t max_depth;
  int32_t depth_budget;
  int32_t roulette_depth;
  Strategy strategy;

  static constexpr const char* name = "path";
  static constexpr const char* doc = "Path tracing with next-event estimation and multiple importance sampling.";
  static constexpr auto params() {
    return param_list(
        Param{.name = "max_depth",
              .kind = Kind::integer,
              .doc = "Largest number of scattering events: 0 shows emission, 1 direct light, -1 all light.",
              .preset = "-1",
              .low = -1,
              .high = 1e6,
              .member = ACCURAY_OFFSET_OF(PathTracing, max_depth)},
        Param{.name = "depth_budget",
              .kind = Kind::integer,
              .doc =
                  "Weighted depth that a path may spend: a smooth transmission costs 1, a mirror reflection and what "
                  "a glossy surface does 2, a diffuse reflection 4; 0 sets no such limit.",
              .preset = "0",
              .low = 0,
              .high = 1e6,
              .member = ACCURAY_OFFSET_OF(PathTracing, depth_budget)},
        Param{.name = "roulette_depth",
              .kind = Kind::integer,
              .doc = "Scattering events before Russian roulette starts; it never biases the picture.",
              .preset = "5",
              .low = 1,
              .high = 1e6,
              .member = ACCURAY_OFFSET_OF(PathTracing, roulette_depth)},
        Param{
            .name = "strategy",
            .kind = Kind::choice,
            .doc = "Which estimates of direct light count: mis combines both and is the best; light and bsdf use one.",
            .preset = "\"mis\"",
            .choices = "mis|light|bsdf",
            .member = ACCURAY_OFFSET_OF(PathTracing, strategy)});
  }

  // The same paths as far as their first scattering event.
  PathTracing direct_part() const { return {first_event(max_depth), depth_budget, roulette_depth, strategy}; }

  bool may_scatter(const Path& path) const { return max_depth < 0 || path.depth < static_cast<uint32_t>(max_depth); }
  bool can_afford(const Path& path, uint32_t lobe) const {
    return depth_budget == 0 || path.spent + depth_cost(lobe) <= static_cast<uint32_t>(depth_budget);
  }

  // Step shade_surface: emission, direct light, and the direction in which the path goes on.
  template <Accel A>
  void shade_surface(const SceneView& scene, const A& accel, Path& path) const {
    Surface surface = surface_at(scene, path.ray, path.hit);
    const Part part = part_at(scene, surface, path);
    const MaterialRecord& material = scene.materials[part.material];
    travel(scene, material, surface, path);
    const uint32_t exterior = exterior_at(scene, material, surface, path);
    if (pass_hidden(scene, material, surface, exterior, path)) return;
    const Vec3 toward_viewer = -path.ray.direction;

    // Emission met by the path itself.
    if (surface.light != none) {
      const Spectrum emission = emitted(scene, path.hit, surface, toward_viewer, path.ray.time, path.wl);
      if (!is_black(emission)) {
        const float weight = hit_weight(scene, strategy, departure(path), path.ray.direction, surface.light, surface);
        path.radiance = fma(path.throughput * weight, emission, path.radiance);
      }
    }
    path.alive = may_scatter(path);
    if (!path.alive) return;
    show(part, surface, path);

    // The sample's numbers for this vertex; the second set is drawn where something needs it.
    const f32x4 u_direction = path.sampler.draw(direction_set(path));
    const Vec2 u_light = {u_direction[2], u_direction[3]};
    const Vec2 u_bsdf = {u_direction[0], u_direction[1]};
    const f32x4 u_decision =
        needs_decisions(scene, material, path) ? path.sampler.draw(decision_set(path)) : lanes(0.0f);
    const float u_choice = u_decision[0];
    const float u_lobe = u_decision[1];
    const float u_roulette = u_decision[2];

    const ShadingPoint point = shading_point(scene, material, path, surface, exterior);
    const Frame frame = shading_frame(scene, material, surface, point, path);
    const Vec3 wo = frame.to_local(toward_viewer);
    path.alive = dispatch(Bsdfs{}, material.bsdf.tag, [&](auto type) {
      using Bsdf = typename decltype(type)::type;
      const auto bsdf = scene.as<Bsdf>(material.bsdf).at(point);
      if (!bsdf.is_delta() && can_afford(path, bsdf.lobe)) {
        sample_light(scene, accel, strategy, material, surface, frame, bsdf, wo, u_light, u_choice, path);
      }
      const BsdfSample sample = bsdf.sample(wo, u_lobe, u_bsdf);
      return can_afford(path, sample.lobe) && scatter(scene, material, surface, frame, sample, path);
    });
    if (path.alive) path.alive = survives(path, static_cast<uint32_t>(roulette_depth), u_roulette);
  }

  template <Accel A>
  void trace(const SceneView& scene, const A& accel, Path& path) const {
    while (path.alive) {
      intersect(scene, accel, path);
      if (path.hit.geometry == none) {
        shade_miss(scene, strategy, path);
      } else {
        shade_surface(scene, accel, path);
      }
    }
  }

 private:
  // With one light, a BSDF of one lobe and no roulette yet, nothing would read the second set.
  bool needs_decisions(const SceneView& scene, const MaterialRecord& material, const Path& path) const {
    return scene.root->lights.count > 1 || material.bsdf.tag != tag_of<Diffuse>(Bsdfs{}) ||
           path.depth + 1 >= static_cast<uint32_t>(roulette_depth);
  }
};

}  // namespace accuray
