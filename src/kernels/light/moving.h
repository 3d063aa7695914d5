// Surface lights on instances that move: kept in the space of their prototype, asked at the time of the path.
//
// The point or direction is chosen there, by the light's own technique, and carried into the world by where the
// instance is. A linear map A takes the solid angle about a unit vector d by the factor |det A| / |A d|^3, so the
// density stays exact whatever the placement does to lengths and angles.
#pragma once

#include "kernels/geometry/motion.h"
#include "kernels/light/list.h"

namespace accuray {

// fn of the light, which is one of a surface; `otherwise` of the types that are none.
template <class Result, class Fn>
inline Result with_surface_light(const SceneView& scene, Tagged light, Result otherwise, Fn&& fn) {
  return dispatch(Lights{}, light.tag, [&](auto type) {
    using L = typename decltype(type)::type;
    if constexpr (requires(const L& l) { l.at(Vec2{}); }) {
      return fn(scene.as<L>(light));
    } else {
      return otherwise;
    }
  });
}

inline float density_carried(float pdf, float stretch, float determinant) {
  return pdf * (stretch * stretch * stretch / abs(determinant));
}

ACCURAY_NOINLINE inline LightSample sample_moving(const SceneView& scene, const LightRecord& record, Vec3 reference,
                                                  float time, Vec2 u) {
  const Moment moment = moment_of(scene, record.motion, time);
  const Placement at = placement(moment);
  const Vec3 from = at.to_object.point(reference);
  LightSample s =
      with_surface_light(scene, record.light, no_light(), [&](const auto& light) { return light.sample(from, u); });
  if (s.pdf == 0.0f) return s;
  const Vec3 way = at.to_world.vector(s.wi);
  const float stretch = length(way);
  s.wi = way * (1.0f / stretch);
  s.error = at.to_world.spread(s.error) + rounding_at(moment, s.point);
  s.point = at.to_world.point(s.point);
  s.normal = normal_by(at.to_object, s.normal);
  s.distance *= stretch;
  s.pdf = density_carried(s.pdf, stretch, at.determinant);
  return s;
}

// `point` and `normal`: where the way meets the light.
ACCURAY_NOINLINE inline float moving_pdf(const SceneView& scene, const LightRecord& record, Vec3 reference, float time,
                                         Vec3 wi, Vec3 point, Vec3 normal) {
  const Placement at = placement(moment_of(scene, record.motion, time));
  const Vec3 from = at.to_object.point(reference);
  const Vec3 way = at.to_object.vector(wi);
  const float shrink = length(way);
  Surface met{};
  met.point = at.to_object.point(point);
  met.normal = normal_by(at.to_world, normal);  // normals go back by the transform itself, transposed
  const float pdf = with_surface_light(scene, record.light, 0.0f,
                                       [&](const auto& light) { return light.pdf(from, way * (1.0f / shrink), met); });
  return density_carried(pdf, 1.0f / shrink, at.determinant);
}

}  // namespace accuray
