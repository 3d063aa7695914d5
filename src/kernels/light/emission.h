// Emission that a texture gives: the same function of the place, whether a path met the light there or chose the point.
#pragma once

#include "kernels/light/select.h"
#include "kernels/texture/list.h"

namespace accuray {

// Barycentric coordinates, of vertices 1 and 2, of a point in the plane of a triangle.
inline Vec2 barycentric(const Triangle& tri, Vec3 point) {
  const Vec3 e1 = tri.p1 - tri.p0;
  const Vec3 e2 = tri.p2 - tri.p0;
  const Vec3 d = point - tri.p0;
  const Vec3 n = cross(e1, e2);
  const float scale = 1.0f / length_squared(n);
  return {dot(cross(d, e2), n) * scale, dot(cross(e1, d), n) * scale};
}

// The hit of a ray that meets a light at a point of it.
inline Hit hit_on_light(const SceneView& scene, uint32_t light, Vec3 point, float time) {
  const LightPlace place = scene.light_places[light];
  Hit hit;
  hit.geometry = place.geometry;
  hit.instance = place.instance;
  hit.primitive = place.primitive;
  const Tagged shape = scene.geometries[place.geometry].shape;
  if (shape.tag != tag_of<Mesh>(Shapes{})) return hit;
  const Mesh& mesh = scene.as<Mesh>(shape);
  const uint32_t motion = scene.lights[light].motion;
  if (motion != none) {
    point = into_moving(scene, motion, {point, {0.0f, 0.0f, 0.0f}, infinity, time}).origin;
  } else if (place.instance != none) {
    point = scene.instances[place.instance].to_world.point_back(point);
  }
  Vec2 b = barycentric(triangle_of(scene, mesh, hit.primitive, time), point);
  const bool outside = min(b.x, min(b.y, 1.0f - b.x - b.y)) < 0.0f;
  if (outside && scene.lights[light].light.tag == tag_of<QuadLight>(Lights{})) {
    ++hit.primitive;
    b = barycentric(triangle_of(scene, mesh, hit.primitive, time), point);
  }
  hit.u = b.x;
  hit.v = b.y;
  return hit;
}

// What a textured light emits at a hit.
ACCURAY_NOINLINE inline Spectrum emission_met(const SceneView& scene, const SpectrumRecord& emission, Hit hit,
                                              Surface surface, float time, Wavelengths wl) {
  return textured_spectrum(scene, emission, texture_point(scene, hit, surface, time), wl);
}

// The texture point of a place on a light; textures ask for no tangents.
inline TexturePoint point_on_light(const SceneView& scene, uint32_t light, Vec3 point, float time) {
  Surface surface{};
  surface.point = point;
  surface.normal = {0.0f, 0.0f, 1.0f};
  return texture_point(scene, hit_on_light(scene, light, point, time), surface, time);
}

// Radiance of an infinite light in a direction.
ACCURAY_NOINLINE inline Spectrum radiance_from(const SceneView& scene, uint32_t light, Vec3 wi, Wavelengths wl) {
  const LightRecord& record = scene.lights[light];
  const SpectrumRecord& emission = scene.spectra[record.emission.index];
  return dispatch(Lights{}, record.light.tag, [&](auto type) {
    const auto& met = scene.as<typename decltype(type)::type>(record.light);
    if constexpr (requires { met.radiance(scene, emission, wi, wl); }) {
      return met.radiance(scene, emission, wi, wl);
    } else {
      return evaluate(emission, scene.tables, wl);
    }
  });
}

// What a ray that leaves the scene meets of one.
inline Spectrum radiance_met(const SceneView& scene, const InfiniteRecord& infinite, Vec3 wi, const Wavelengths& wl) {
  if (infinite.directional != 0) [[unlikely]]
    return radiance_from(scene, infinite.light, wi, wl);
  return scene.spectrum(scene.lights[infinite.light].emission, wl);
}

// What a light whose emission is not the same everywhere emits at a chosen point, or in a direction if it is infinite.
ACCURAY_NOINLINE inline Spectrum emission_chosen(const SceneView& scene, const SpectrumRecord& emission, uint32_t light,
                                                 Vec3 point, float time, Wavelengths wl) {
  if (is_infinite_light(scene.lights[light].light.tag)) return radiance_from(scene, light, point, wl);
  return textured_spectrum(scene, emission, point_on_light(scene, light, point, time), wl);
}

}  // namespace accuray
