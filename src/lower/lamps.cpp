#include "lower/lamps.h"

#include <cmath>

#include "kernels/math/functions.h"
#include "lower/double3.h"

namespace accuray {

namespace {

constexpr double kRadians = M_PI / 180.0;

Double3 axis_of(const Values& values) {
  if (!values.contains("target")) {
    return unit(vec_of(values, "direction"), "direction", "has no direction: allowed is any length but zero");
  }
  return unit(difference(vec_of(values, "target"), vec_of(values, "position")), "target",
              "is where the light stands: allowed is any point but its position");
}

// 1 - cos, without the cancellation of small angles.
double versine(double angle) {
  const double half = sincos(0.5 * angle).sin;
  return 2.0 * half * half;
}

// Integral of the share over directions: the closed form of each falloff between the angles a and b.
double solid_angle(SpotFalloff falloff, double a, double b) {
  const double within = versine(a);
  const double between = versine(b) - within;
  if (falloff == SpotFalloff::smooth) return 2.0 * M_PI * (within + between / 2.0);
  if (falloff == SpotFalloff::square) return 2.0 * M_PI * (within + between / 3.0);
  const SinCosDouble inner = sincos(a);
  const SinCosDouble outer = sincos(b);
  return 2.0 * M_PI * (b > a ? 1.0 - (outer.sin - inner.sin) / (b - a) : within);
}

std::vector<float> radians(const std::vector<double>& degrees) {
  std::vector<float> result;
  result.reserve(degrees.size());
  for (const double angle : degrees) result.push_back(static_cast<float>(angle * kRadians));
  return result;
}

// Flux of a lune of one radian: candelas linear in the vertical angle, against the sine.
double flux_per_radian(const double* candela, const std::vector<double>& vertical) {
  double sum = 0.0;
  for (size_t i = 0; i + 1 < vertical.size(); ++i) {
    const SinCosDouble a = sincos(vertical[i] * kRadians);
    const SinCosDouble b = sincos(vertical[i + 1] * kRadians);
    const double slope = (b.sin - a.sin) / ((vertical[i + 1] - vertical[i]) * kRadians);
    sum += candela[i] * (a.cos - slope) + candela[i + 1] * (slope - b.cos);
  }
  return sum;
}

// Largest angle from the axis that light leaves by, degrees.
double last_lit(const Photometry& photometry) {
  const size_t count = photometry.vertical.size();
  size_t last = 0;
  for (size_t i = 0; i < photometry.candela.size(); ++i) {
    if (photometry.candela[i] > 0.0) last = std::max(last, i % count + 1);
  }
  return photometry.vertical[std::min(last, count - 1)];
}

}  // namespace

double Photometry::lumens() const {
  const size_t count = vertical.size();
  if (horizontal.size() == 1) return 2.0 * M_PI * flux_per_radian(candela.data(), vertical);
  double sum = 0.0;
  for (size_t i = 0; i + 1 < horizontal.size(); ++i) {
    const double mean =
        flux_per_radian(&candela[i * count], vertical) + flux_per_radian(&candela[(i + 1) * count], vertical);
    sum += 0.5 * mean * (horizontal[i + 1] - horizontal[i]) * kRadians;
  }
  return sum;
}

Lamp<SpotLight> lamp_of(Type<SpotLight>, const Values& values, const Photometry&) {
  auto spot = struct_of<SpotLight>(values);
  const double outer = number_of(values, "outer_angle");
  const double inner = number_of(values, "inner_angle");
  if (inner > outer) throw BadParameter("inner_angle", "is beyond the outer angle: allowed at most outer_angle");
  spot.axis = to_vec3(axis_of(values));
  spot.versine_inner = static_cast<float>(versine(inner));
  spot.versine_outer = static_cast<float>(versine(outer));
  spot.solid_angle = static_cast<float>(solid_angle(spot.falloff, inner, outer));
  return {spot, {}};
}

Lamp<DirectionalLight> lamp_of(Type<DirectionalLight>, const Values& values, const Photometry&) {
  return {{to_vec3(axis_of(values))}, {}};
}

Lamp<IesLight> lamp_of(Type<IesLight>, const Values& values, const Photometry& photometry) {
  auto light = struct_of<IesLight>(values);
  const Double3 axis = axis_of(values);
  constexpr const char* no_plane = "is no direction across the light: allowed is any that is not along it, and not 0";
  const Double3 c0 = unit(vec_of(values, "c0"), "c0", no_plane);
  const Double3 c90 = cross(c0, axis);
  if (!(length(c90) > 1e-6)) throw BadParameter("c0", no_plane);
  light.axis = to_vec3(axis);
  light.c90 = to_vec3(unit(c90, "c0", no_plane));
  light.c0 = to_vec3(cross(axis, unit(c90, "c0", no_plane)));
  light.verticals = static_cast<uint32_t>(photometry.vertical.size());
  light.horizontals = static_cast<uint32_t>(photometry.horizontal.size());
  light.lumens = static_cast<float>(photometry.lumens());
  light.cos_emission = static_cast<float>(sincos(last_lit(photometry) * kRadians).cos);
  std::vector<float> table = radians(photometry.vertical);
  const std::vector<float> horizontal = radians(photometry.horizontal);
  table.insert(table.end(), horizontal.begin(), horizontal.end());
  table.insert(table.end(), photometry.candela.begin(), photometry.candela.end());
  return {light, std::move(table)};
}

double lamp_power(std::string_view type, const Values& values, const Photometry& photometry) {
  return dispatch(NamedLights{}, tag_named(NamedLights{}, type), [&](auto named) {
    const auto lamp = lamp_of(named, values, photometry);
    return static_cast<double>(lamp.light.power_per_radiance(0.0f));
  });
}

}  // namespace accuray
