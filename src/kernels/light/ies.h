// A point with a measured distribution of luminous intensity (IES LM-63, type C photometry).
//
// Conventions
//   - Vertical angles count from `axis` (the nadir of a luminaire that hangs), horizontal ones from `c0` towards
//     `c90`: counter-clockwise for whoever looks along the axis from behind the luminaire.
//   - The table lies in the pool of parameters right behind the struct: vertical angles, horizontal angles (radians,
//     rising; from 0 to 2 pi, or a single one for rotational symmetry), then for each horizontal angle the candelas at
//     all vertical ones. Between the angles it is bilinear; beyond the vertical ones it is dark.
//   - The emission is the spectral intensity, W/(sr nm), for one candela.
#pragma once

#include "kernels/light/aim.h"
#include "kernels/math/functions.h"
#include "kernels/math/interval.h"

namespace accuray {

struct IesLight {
  Vec3 position;
  Vec3 axis, c0, c90;  // unit, perpendicular
  uint32_t verticals, horizontals;
  float lumens;        // of the table
  float cos_emission;  // of the angle from the axis beyond which it is dark

  static constexpr bool delta = true;
  static constexpr bool infinite = false;
  static constexpr const char* name = "ies";
  static constexpr const char* doc =
      "A point with the measured light distribution of a luminaire, from an IES file (LM-63 of 1986 to 2019, type C); "
      "no path can hit it.";
  static constexpr auto params() {
    return joined(
        joined(param_list(Param{.name = "file",
                                .kind = Kind::file,
                                .doc = "IES file (LM-63) with type C photometry.",
                                .choices = ".ies",
                                .role = "photometry",
                                .required = true},
                          Param{.name = "position",
                                .kind = Kind::vec,
                                .doc = "Where it is.",
                                .preset = "[0, 0, 0]",
                                .unit = "m",
                                .animatable = true,
                                .member = ACCURAY_OFFSET_OF(IesLight, position)}),
               aim_params()),
        param_list(
            Param{
                .name = "c0",
                .kind = Kind::vec,
                .doc = "Where the file's horizontal angle 0 lies, seen from the light; its part across the aim counts.",
                .preset = "[1, 0, 0]",
                .animatable = true},
            Param{.name = "spectrum",
                  .kind = Kind::spectrum,
                  .doc = "Spectral distribution of the light; its amount is that of the file.",
                  .preset = "1",
                  .low = 0,
                  .unit = "1",
                  .role = "emission",
                  .animatable = true},
            Param{.name = "multiplier",
                  .doc = "Factor of the file's candelas.",
                  .preset = "1",
                  .low = 0,
                  .animatable = true},
            Param{.name = "flux",
                  .doc = "All light that leaves the luminaire, in place of the file's.",
                  .low = 0,
                  .unit = "lm",
                  .group = "output?:flux",
                  .animatable = true},
            Param{.name = "lamp_lumens",
                  .doc = "Flux of the bare lamps together, in place of the file's; for files of relative photometry.",
                  .low = 0,
                  .unit = "lm",
                  .group = "output?:lamps",
                  .animatable = true}));
  }

  const float* vertical() const { return reinterpret_cast<const float*>(this + 1); }
  const float* horizontal() const { return vertical() + verticals; }
  const float* candela() const { return horizontal() + horizontals; }

  // A place between two angles of a rising list, at least two of them; held at its ends.
  struct Between {
    uint32_t index;
    float along;
  };
  static Between between(const float* angles, uint32_t count, float angle) {
    const uint32_t low = interval_of(angles, count - 1, angle);
    return {low, clamp((angle - angles[low]) / (angles[low + 1] - angles[low]), 0.0f, 1.0f)};
  }
  // Between two candelas of one horizontal angle.
  static float mixed(const float* values, Between at) {
    return fma(at.along, values[at.index + 1] - values[at.index], values[at.index]);
  }

  // Candelas towards a local direction: x to c0, y to c90, z along the axis.
  ACCURAY_NOINLINE float towards(Vec3 d) const {
    const float theta = atan2(sqrt(fma(d.x, d.x, d.y * d.y)), d.z);
    if (theta < vertical()[0] || theta > vertical()[verticals - 1]) return 0.0f;
    const Between v = between(vertical(), verticals, theta);
    if (horizontals == 1) return mixed(candela(), v);
    const float phi = atan2(d.y, d.x);
    const Between h = between(horizontal(), horizontals, phi < 0.0f ? phi + 2.0f * pi : phi);
    const float* values = candela() + size_t{h.index} * verticals;
    return fma(h.along, mixed(values + verticals, v) - mixed(values, v), mixed(values, v));
  }

  LightSample sample(Vec3 reference, Vec2) const {
    LightSample s = sample_point(reference, position);
    s.scale *= towards({-dot(s.wi, c0), -dot(s.wi, c90), -dot(s.wi, axis)});
    return s;
  }
  float pdf(Vec3, Vec3, const Surface&) const { return 0.0f; }
  float power_per_radiance(float) const { return lumens; }
  LightBounds bounds() const { return {position, position, axis, 1.0f, max(cos_emission - cone_slack, -1.0f)}; }
};

}  // namespace accuray
