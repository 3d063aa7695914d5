// What every light offers.
//
// Conventions
//   - sample(reference, u) chooses a point of the light for a reference point; `pdf` is per solid angle at the
//     reference. A failed sample has pdf 0. Lights that no path can hit (`delta`) have pdf 1.
//   - pdf(reference, wi, surface) is the density with which sample() would have chosen the direction wi, whose ray
//     met the light at `surface`.
//   - at(u) of a light that is a surface is a point chosen uniformly by area.
//   - The radiance arriving along the sample is the light's emission times `scale`: 1 for surfaces and environments,
//     1/d^2 for a point, 0 on a side that does not emit.
//   - power_per_radiance(scene_radius) is the flux per unit of emission: that of one side of a surface, and what an
//     infinite light sends into a sphere around the scene.
//   - `infinite` lights lie beyond everything; a sample's `point` is its direction. Those whose radiance differs from
//     direction to direction have radiance(scene, emission, wi, wl). The others have bounds(), by which the light tree
//     groups them. Lights that read tables take the scene as the first argument of sample() and pdf().
#pragma once

#include "kernels/geometry/surface.h"
#include "kernels/sampling/warp.h"

namespace accuray {

struct LightSample {
  Vec3 wi;      // unit, from the reference to the light
  Vec3 point;   // on the light; `wi` if the distance is infinite
  Vec3 error;   // bound of the point's error
  Vec3 normal;  // of the light there; zero for points
  float distance;
  float pdf;
  float scale;
};

// Where a light is and where it sends light (Conty Estevez and Kulla 2018): directions within `cos_spread` of the axis
// are normals, and light leaves within `cos_emission` of a normal.
struct LightBounds {
  Vec3 low;
  Vec3 high;
  Vec3 axis;
  float cos_spread;
  float cos_emission;
};

// How far lights at a point lower the cosine that bounds them, so that rounding darkens no direction.
constexpr float cone_slack = 1e-6f;

inline LightSample no_light() { return {{0, 0, 1}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 0.0f, 0.0f, 0.0f}; }

// A flat light is sampled by solid angle from near by, where the density of its points varies without bound, and by
// area from afar, where that is as good and cheaper. The same function of the reference decides in sample() and pdf().
inline bool is_near(Vec3 reference, Vec3 middle, float radius_squared) {
  return length_squared(middle - reference) < 16.0f * radius_squared;
}

// A direction drawn by an infinite light. Its draw() and density() are never inlined: most scenes have no such light,
// and threads of a GPU little memory.
struct Drawn {
  Vec3 wi;
  float pdf;
};
template <class L>
ACCURAY_NOINLINE inline Drawn drawn_by(const L& light, const SceneView& scene, Vec2 u) {
  return light.draw(scene, u);
}
template <class L>
ACCURAY_NOINLINE inline float density_of(const L& light, const SceneView& scene, Vec3 wi) {
  return light.density(scene, wi);
}

// A sample of a light beyond everything.
inline LightSample sample_from_afar(Drawn drawn) {
  return {drawn.wi, drawn.wi, {0, 0, 0}, {0, 0, 0}, infinity, drawn.pdf, drawn.pdf > 0.0f ? 1.0f : 0.0f};
}

// The parameter of infinite lights that hides them.
constexpr Param visible_param() {
  return {.name = "visible",
          .kind = Kind::boolean,
          .doc = "Whether the camera sees it directly. It lights the scene, mirrors and glass either way.",
          .preset = "true"};
}

// Solid angles beyond these bounds (sr) are left to area sampling too: the spherical formulas err by 1e-7 sr.
constexpr float least_spherical = 1e-3f;
constexpr float most_spherical = 6.2f;

// Density per solid angle of a point chosen uniformly over `area`.
inline float area_to_solid_angle(float area, float distance_squared, float cosine) {
  return cosine > 0.0f ? distance_squared / (area * cosine) : 0.0f;
}

// A light sample for a chosen point of a flat light; pdf is left to the caller if it is not by area.
inline LightSample sample_towards(Vec3 reference, Vec3 point, Vec3 error, Vec3 normal, float area) {
  const Vec3 d = point - reference;
  const float squared = length_squared(d);
  if (!(squared > 0.0f)) return no_light();
  const float distance = sqrt(squared);
  const Vec3 wi = d * (1.0f / distance);
  return {wi, point, error, normal, distance, area_to_solid_angle(area, squared, abs(dot(normal, wi))), 1.0f};
}

}  // namespace accuray
