// A point that lights a cone.
//
// The intensity is whole within the inner angle and falls to zero at the outer one (the cone of glTF's
// KHR_lights_punctual). `t` goes from 0 at the outer angle to 1 at the inner one.
#pragma once

#include "kernels/light/aim.h"
#include "kernels/math/functions.h"

namespace accuray {

enum class SpotFalloff : uint32_t {
  smooth,  // 3 t^2 - 2 t^3, t linear in the cosine (Pharr, Jakob and Humphreys 2023, section 12.2.1)
  square,  // t^2, t linear in the cosine, as KHR_lights_punctual suggests
  linear   // t, linear in the angle
};

struct SpotLight {
  Vec3 position;
  Vec3 axis;           // unit
  float inner, outer;  // half-angles, radians
  SpotFalloff falloff;
  float versine_inner, versine_outer;  // 1 - cos of these
  float solid_angle;                   // flux over intensity, sr

  static constexpr bool delta = true;
  static constexpr bool infinite = false;
  static constexpr const char* name = "spot";
  static constexpr const char* doc = "A point that lights a cone, brightest about its axis; no path can hit it.";
  static constexpr auto params() {
    return joined(
        joined(param_list(Param{.name = "position",
                                .kind = Kind::vec,
                                .doc = "Where it is.",
                                .preset = "[0, 0, 0]",
                                .unit = "m",
                                .animatable = true,
                                .member = ACCURAY_OFFSET_OF(SpotLight, position)}),
               aim_params()),
        param_list(
            Param{.name = "outer_angle",
                  .doc = "Angle between the axis and the edge of the cone, beyond which it is dark.",
                  .preset = "45",
                  .low = 0.01,
                  .high = 180,
                  .unit = "deg",
                  .animatable = true,
                  .member = ACCURAY_OFFSET_OF(SpotLight, outer)},
            Param{.name = "inner_angle",
                  .doc = "Angle from the axis within which the intensity is whole; at most outer_angle.",
                  .preset = "0",
                  .low = 0,
                  .high = 180,
                  .unit = "deg",
                  .animatable = true,
                  .member = ACCURAY_OFFSET_OF(SpotLight, inner)},
            Param{.name = "falloff",
                  .kind = Kind::choice,
                  .doc =
                      "From the outer angle, t = 0, to the inner one, t = 1: smooth is 3t^2 - 2t^3 and square t^2, t "
                      "being linear in the cosine; linear is t itself, linear in the angle.",
                  .preset = "\"smooth\"",
                  .choices = "smooth|square|linear",
                  .member = ACCURAY_OFFSET_OF(SpotLight, falloff)},
            Param{.name = "intensity",
                  .kind = Kind::spectrum,
                  .doc = "Spectral radiant intensity within the inner angle.",
                  .preset = "1",
                  .low = 0,
                  .unit = "W/(sr nm)",
                  .role = "emission",
                  .takes_flux = true,
                  .animatable = true}));
  }

  // Angle whose versine this is, without the cancellation of acos(1 - v).
  static float angle_of(float versine) { return 2.0f * asin(sqrt(min(0.5f * versine, 1.0f))); }

  // Share of the intensity at a versine of the angle from the axis.
  static ACCURAY_NOINLINE float share(SpotLight spot, float versine) {
    if (versine <= spot.versine_inner) return 1.0f;
    if (!(versine < spot.versine_outer)) return 0.0f;
    if (spot.falloff == SpotFalloff::linear)
      return clamp((spot.outer - angle_of(versine)) / (spot.outer - spot.inner), 0.0f, 1.0f);
    const float t = (spot.versine_outer - versine) / (spot.versine_outer - spot.versine_inner);
    return spot.falloff == SpotFalloff::square ? t * t : t * t * (3.0f - 2.0f * t);
  }

  LightSample sample(Vec3 reference, Vec2) const {
    LightSample s = sample_point(reference, position);
    // The chord between unit vectors keeps its digits in narrow beams, which the cosine does not.
    s.scale *= share(*this, 0.5f * length_squared(s.wi + axis));
    return s;
  }
  float pdf(Vec3, Vec3, const Surface&) const { return 0.0f; }
  float power_per_radiance(float) const { return solid_angle; }
  LightBounds bounds() const { return {position, position, axis, 1.0f, max(1.0f - versine_outer - cone_slack, -1.0f)}; }
};

}  // namespace accuray
