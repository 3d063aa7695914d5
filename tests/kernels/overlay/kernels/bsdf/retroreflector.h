// A surface that sends light back to where it came from, spread by a power of the cosine: traffic signs, bicycle
// reflectors. It is no part of the renderer: the tests build with it to show that a BSDF is one header and one word.
#pragma once

#include "kernels/bsdf/bsdf.h"
#include "kernels/math/functions.h"

namespace accuray {

struct RetroreflectorAt {
  Spectrum reflectance;
  float exponent;

  static constexpr uint32_t lobe = lobe_diffuse;
  static constexpr bool is_delta() { return false; }

  // Cosine of the angle between the directions to its power; 0 across the surface.
  float peak(Vec3 wo, Vec3 wi) const {
    const float cosine = min(dot(wo, wi), 1.0f);
    if (!(wo.z * wi.z > 0.0f && cosine > 0.0f)) return 0.0f;
    return static_cast<float>(pow(static_cast<double>(cosine), static_cast<double>(exponent)));
  }
  // Scaled so that light along the normal is reflected whole (Lewis 1994).
  Spectrum eval(Vec3 wo, Vec3 wi) const {
    return reflectance * ((exponent + 2.0f) * 0.5f * inv_pi * peak(wo, wi) * abs(wi.z));
  }
  float pdf(Vec3 wo, Vec3 wi) const { return (exponent + 1.0f) * 0.5f * inv_pi * peak(wo, wi); }
  BsdfSample sample(Vec3 wo, float, Vec2 u) const {
    const double height = pow(static_cast<double>(u.x), 1.0 / (static_cast<double>(exponent) + 1.0));
    const float cosine = static_cast<float>(height);
    const float sine = static_cast<float>(sqrt(max(0.0, 1.0 - height * height)));
    const SinCos phi = sincos(2.0f * pi * u.y);
    const Vec3 wi = Frame::around(wo).to_world({sine * phi.cos, sine * phi.sin, cosine});
    const float density = pdf(wo, wi);
    if (density == 0.0f) return no_sample();
    const Spectrum weight = reflectance * ((exponent + 2.0f) / (exponent + 1.0f) * abs(wi.z));
    return {wi, weight, density, lobe_diffuse, 1.0f};
  }
};

struct Retroreflector {
  SpectrumRef reflectance;
  float exponent;

  static constexpr const char* name = "retroreflector";
  static constexpr const char* doc = "Sends light back to where it came from.";
  static constexpr Keeps keeps{.exact_pdf = true, .reciprocal = true, .energy_conserving = true};
  static constexpr auto params() {
    return param_list(Param{.name = "reflectance",
                            .kind = Kind::spectrum,
                            .doc = "Share of the light along the normal that is reflected.",
                            .preset = "0.5",
                            .low = 0,
                            .high = 1,
                            .unit = "1",
                            .role = "reflectance",
                            .member = ACCURAY_OFFSET_OF(Retroreflector, reflectance)},
                      Param{.name = "exponent",
                            .kind = Kind::real,
                            .doc = "Power of the cosine: the larger, the narrower.",
                            .preset = "20",
                            .low = 0,
                            .high = 100,
                            .member = ACCURAY_OFFSET_OF(Retroreflector, exponent)});
  }
  RetroreflectorAt at(const ShadingPoint& p) const { return {p.spectrum(reflectance), exponent}; }
};

}  // namespace accuray
