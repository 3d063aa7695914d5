// The steps that integrators share. Each is a plain function of (scene, intersector, path); none knows who runs it.
#pragma once

#include "kernels/accel/accel.h"
#include "kernels/bsdf/list.h"
#include "kernels/integrator/shading.h"
#include "kernels/integrator/weights.h"
#include "kernels/light/emission.h"
#include "kernels/light/select.h"
#include "kernels/texture/opacity.h"

namespace accuray {

// Which estimates of direct light count: both with multiple importance sampling, or one alone (for tests).
enum class Strategy : uint32_t { mis, light, bsdf };

// What decides about partly opaque surfaces at this vertex: one stream for the path, one for light that it asks for.
enum class OpacityStream : uint32_t { path = 0x6f706163u, light = 0x6f706c74u };
inline uint32_t opacity_key(const Path& path, OpacityStream stream) {
  return hash(path.sampler.key, path.sampler.index, path.depth, static_cast<uint32_t>(stream));
}

template <Accel A>
inline void intersect(const SceneView& scene, const A& accel, Path& path) {
  if (scene.root->any_opacity != 0) [[unlikely]] {
    const Stop stop = closest_opaque(scene, accel, path.ray, opacity_key(path, OpacityStream::path));
    path.hit = stop.hit;
    path.ray.origin = stop.origin;
  } else {
    path.hit = accel.closest(path.ray);
  }
}

// Radiance that the surface sends back along the ray.
inline Spectrum emitted(const SceneView& scene, const Hit& hit, const Surface& surface, Vec3 wo, float time,
                        const Wavelengths& wl) {
  const LightRecord& light = scene.lights[surface.light];
  if (light.both_sides == 0 && dot(surface.normal, wo) <= 0.0f) return lanes(0.0f);
  const SpectrumRecord& emission = scene.spectra[light.emission.index];
  if (is_textured(emission.form)) [[unlikely]]
    return emission_met(scene, emission, hit, surface, time, wl);
  return evaluate(emission, scene.tables, wl);
}

// What a light emits where a point of it was chosen.
inline Spectrum sampled_emission(const SceneView& scene, uint32_t light, Vec3 point, float time,
                                 const Wavelengths& wl) {
  const SpectrumRecord& emission = scene.spectra[scene.lights[light].emission.index];
  if (is_textured(emission.form)) [[unlikely]]
    return emission_chosen(scene, emission, light, point, time, wl);
  return evaluate(emission, scene.tables, wl);
}

// Where the path's ray comes from, and its density there; 0 if no other technique could have chosen it.
struct Departure {
  Vec3 point, normal;
  float time, pdf;
};
inline Departure departure(const Path& path) { return {path.origin, path.origin_normal, path.ray.time, path.bsdf_pdf}; }

// Weight of light that the path met by itself, given that sample_light might have found it too.
inline float hit_weight(const SceneView& scene, Strategy strategy, const Departure& from, Vec3 wi, uint32_t light,
                        const Surface& at) {
  if (from.pdf == 0.0f || strategy == Strategy::bsdf) return 1.0f;
  if (strategy == Strategy::light) return 0.0f;
  const float chosen = choice_probability(scene, from.point, from.normal, from.time, light);
  const float pdf = chosen * light_pdf(scene, light, from.point, from.time, wi, at);
  return mis_weight(from.pdf, pdf);
}

// Part of a light sample that arrives: everything but the light's own emission.
template <Accel A>
inline float visible_share(const SceneView& scene, const A& accel, const Path& path, const Surface& surface,
                           const LightSample& light) {
  const Vec3 from = offset_origin(surface.point, surface.error, surface.normal, light.wi);
  Vec3 to = from;
  Ray ray = {from, light.wi, infinity, path.ray.time};
  if (light.distance != infinity) {
    to = offset_origin(light.point, light.error, light.normal, -light.wi);
    ray.direction = to - from;
    ray.far = one_minus_epsilon;
  }
  if (scene.root->any_opacity != 0) [[unlikely]]
    return opaque_transmittance(scene, accel, ray, to, opacity_key(path, OpacityStream::light));
  return accel.transmittance(ray);
}

// Share of a light sample that the body around it lets through.
inline Spectrum share_of_way(const SceneView& scene, const MaterialRecord& material, const Surface& surface,
                             const LightSample& light, bool crosses, const Path& path) {
  if (light.distance == infinity) return lanes(1.0f);
  const uint32_t filling =
      crosses && material.interior != none ? exterior_at(scene, material, surface, path) : path.inside.filling(scene);
  return share_after(scene, filling, light.distance, path.wl);
}

// Share that the surface and the body let through, on whichever side of the surface the light comes from.
inline Spectrum share_towards(const SceneView& scene, const MaterialRecord& material, const Surface& surface,
                              const LightSample& light, const Path& path) {
  const bool crosses = (dot(surface.normal, light.wi) > 0.0f) == leaves(path, surface);
  const Spectrum share = share_of_way(scene, material, surface, light, crosses, path);
  if (crosses && is_tinted(scene, material.interior)) [[unlikely]]
    return share * scene.spectrum(scene.interiors[material.interior].color, path.wl);
  return share;
}

// Step sample_light: next-event estimation at a vertex whose BSDF values are `bsdf`.
template <Accel A, class BsdfAt>
inline void sample_light(const SceneView& scene, const A& accel, Strategy strategy, const MaterialRecord& material,
                         const Surface& surface, const Frame& frame, const BsdfAt& bsdf, Vec3 wo, Vec2 u,
                         float u_choice, Path& path) {
  const Vec3 normal = gathering_normal(material, frame, wo.z);
  const LightChoice choice = choose_light(scene, surface.point, normal, path.ray.time, u_choice);
  if (choice.light == none) return;
  const LightSample light = sample_light(scene, choice.light, surface.point, path.ray.time, u);
  if (light.pdf == 0.0f || light.scale == 0.0f) return;
  const LightRecord& record = scene.lights[choice.light];
  const bool delta = is_delta_light(record.light.tag);
  if (strategy == Strategy::bsdf && !delta) return;

  // A shading normal must not carry light through the true surface.
  const Vec3 wi = frame.to_local(light.wi);
  const bool same_side = (dot(surface.normal, light.wi) > 0.0f) == (wi.z > 0.0f);
  if (!same_side) return;
  const float pdf = light.pdf * choice.probability;
  const bool alone = delta || strategy == Strategy::light;
  const LightValue towards = towards_light(bsdf, wo, wi, pdf, alone);
  if (is_black(towards.value)) return;
  const float share = visible_share(scene, accel, path, surface, light);
  if (share == 0.0f) return;
  Spectrum arriving = sampled_emission(scene, choice.light, light.point, path.ray.time, path.wl) * towards.weight *
                      (light.scale * share / pdf);
  if (path.inside.count != 0 || is_tinted(scene, material.interior))
    arriving *= share_towards(scene, material, surface, light, path);
  path.radiance = fma(path.throughput * towards.value, arriving, path.radiance);
}

// A largest number of scattering events, -1 for any, lowered to one: emission and direct light.
inline int32_t first_event(int32_t max_depth) { return max_depth < 0 || max_depth > 1 ? 1 : max_depth; }

// What a lobe costs of the weighted depth budget (AccuRay report 2014). Both sides of a glossy surface cost the same,
// so that light found by its direction and light found by choosing a lamp end at the same depth.
inline uint32_t depth_cost(uint32_t lobe) {
  if ((lobe & lobe_diffuse) != 0) return 4;
  return (lobe & lobe_specular) != 0 && (lobe & lobe_transmission) != 0 ? 1 : 2;
}

// Continues the path along a BSDF sample; false if there is nothing to continue.
inline bool scatter(const SceneView& scene, const MaterialRecord& material, const Surface& surface, const Frame& frame,
                    const BsdfSample& sample, Path& path) {
  const Vec3 wi = frame.to_world(sample.wi);
  const bool same_side = (dot(surface.normal, wi) > 0.0f) == (sample.wi.z > 0.0f);
  if (!same_side || is_black(sample.weight)) return false;
  path.throughput *= sample.weight;
  if ((sample.lobe & lobe_disperses) != 0 && !path.wl.hero_only) {
    path.throughput = keep_hero(path.throughput);
    path.wl.hero_only = true;
  }
  if ((sample.lobe & lobe_transmission) != 0) {
    cross_surface(material, surface, path);
    if (is_tinted(scene, material.interior)) [[unlikely]]
      path.throughput *= scene.spectrum(scene.interiors[material.interior].color, path.wl);
  }
  path.eta_scale *= sample.eta_scale;
  path.bsdf_pdf = sample.pdf;
  widen_cone(surface.point, sample.pdf, path);
  path.origin = surface.point;
  path.origin_normal = gathering_normal(material, frame, -dot(path.ray.direction, frame.z));
  path.ray.origin = offset_origin(surface.point, surface.error, surface.normal, wi);
  path.ray.direction = wi;
  path.spent += depth_cost(sample.lobe);
  ++path.depth;
  return true;
}

// Russian roulette on the throughput, without the radiance scaling of refraction; false ends the path. By the root:
// paths that carry little live longer than their share, which costs 2 to 10 % of the time and saves 7 to 13 % of the
// variance (Cornell box, rough metal, rough glass).
inline bool survives(Path& path, uint32_t first_depth, float u) {
  if (path.depth < first_depth) return true;
  const float chance = min(sqrt(max_lane(path.throughput) * path.eta_scale), 0.95f);
  if (!(u < chance)) return false;
  path.throughput *= 1.0f / chance;
  return true;
}

}  // namespace accuray
