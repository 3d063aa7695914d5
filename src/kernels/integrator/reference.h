// The naive path tracer that judges all others: no choice of lights, no multiple importance sampling, no cleverness.
// Every path runs until it leaves the scene or the roulette ends it, and only what it meets by itself counts. Lights
// that no path can meet (points) are summed plainly, each of them at each vertex. Never optimise this file.
#pragma once

#include "kernels/integrator/miss.h"
#include "kernels/schema.h"

namespace accuray {

struct Reference {
  int32_t max_depth;

  static constexpr const char* name = "reference";
  static constexpr const char* doc =
      "The naive path tracer that the others are tested against: slow, simple, unbiased.";
  static constexpr auto params() {
    return param_list(Param{.name = "max_depth",
                            .kind = Kind::integer,
                            .doc = "Largest number of scattering events; -1: all.",
                            .preset = "-1",
                            .low = -1,
                            .high = 1e6,
                            .member = ACCURAY_OFFSET_OF(Reference, max_depth)});
  }

  Reference direct_part() const { return {first_event(max_depth)}; }

  template <Accel A>
  void trace(const SceneView& scene, const A& accel, Path& path) const {
    while (path.alive) {
      intersect(scene, accel, path);
      path.bsdf_pdf = 0.0f;  // no other technique could have found what this ray meets
      if (path.hit.geometry == none) {
        shade_miss(scene, Strategy::bsdf, path);
        return;
      }
      Surface surface = surface_at(scene, path.ray, path.hit);
      const Part part = part_at(scene, surface, path);
      const MaterialRecord& material = scene.materials[part.material];
      travel(scene, material, surface, path);
      const uint32_t exterior = exterior_at(scene, material, surface, path);
      if (pass_hidden(scene, material, surface, exterior, path)) continue;
      const Vec3 toward_viewer = -path.ray.direction;
      if (surface.light != none)
        path.radiance += path.throughput * emitted(scene, path.hit, surface, toward_viewer, path.ray.time, path.wl);
      if (max_depth >= 0 && path.depth >= static_cast<uint32_t>(max_depth)) return;
      show(part, surface, path);
      const f32x4 u = path.sampler.draw(direction_set(path));
      const f32x4 u_decision = path.sampler.draw(decision_set(path));
      const ShadingPoint point = shading_point(scene, material, path, surface, exterior);
      const Frame frame = shading_frame(scene, material, surface, point, path);
      const Vec3 wo = frame.to_local(toward_viewer);
      path.alive = dispatch(Bsdfs{}, material.bsdf.tag, [&](auto type) {
        using Bsdf = typename decltype(type)::type;
        const auto bsdf = scene.as<Bsdf>(material.bsdf).at(point);
        add_points(scene, accel, material, surface, frame, bsdf, wo, path);
        return scatter(scene, material, surface, frame, bsdf.sample(wo, u_decision[1], {u[2], u[3]}), path);
      });
      if (path.alive && path.depth >= 8) path.alive = survives(path, 8, u_decision[2]);
    }
  }

 private:
  template <Accel A, class BsdfAt>
  static void add_points(const SceneView& scene, const A& accel, const MaterialRecord& material, const Surface& surface,
                         const Frame& frame, const BsdfAt& bsdf, Vec3 wo, Path& path) {
    for (uint32_t i = 0; i < scene.root->lights.count; ++i) {
      const LightRecord& record = scene.lights[i];
      if (!is_delta_light(record.light.tag)) continue;
      const LightSample light = accuray::sample_light(scene, i, surface.point, path.ray.time, Vec2{0.0f, 0.0f});
      const Vec3 wi = frame.to_local(light.wi);
      if ((dot(surface.normal, light.wi) > 0.0f) != (wi.z > 0.0f)) continue;
      const float share = visible_share(scene, accel, path, surface, light);
      const Spectrum arriving = scene.spectrum(record.emission, path.wl) * (light.scale * share) *
                                share_towards(scene, material, surface, light, path);
      path.radiance += path.throughput * bsdf.eval(wo, wi) * arriving;
    }
  }
};

}  // namespace accuray
