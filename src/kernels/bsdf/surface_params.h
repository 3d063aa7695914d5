// The kinds of parameters that most surfaces have, each with its range and what may give it.
#pragma once

#include "kernels/schema.h"

namespace accuray {

// A share of light by wavelength.
constexpr Param reflectance_param(const char* name, const char* doc, const char* preset, uint32_t member) {
  return {.name = name,
          .kind = Kind::spectrum,
          .doc = doc,
          .preset = preset,
          .low = 0,
          .high = 1,
          .unit = "1",
          .role = "reflectance",
          .texturable = true,
          .animatable = true,
          .member = member};
}

// A refractive index by wavelength.
constexpr Param index_param(const char* name, const char* doc, const char* preset, uint32_t member) {
  return {.name = name,
          .kind = Kind::spectrum,
          .doc = doc,
          .preset = preset,
          .low = 0.05,
          .high = 20,
          .unit = "1",
          .role = "index",
          .texturable = true,
          .animatable = true,
          .member = member};
}

// A number from 0 to 1 without a unit.
constexpr Param share_param(const char* name, const char* doc, const char* preset, uint32_t member) {
  return {.name = name,
          .kind = Kind::real,
          .doc = doc,
          .preset = preset,
          .low = 0,
          .high = 1,
          .texturable = true,
          .animatable = true,
          .member = member};
}

// One of the alternatives of a set.
constexpr Param in_group(Param param, const char* group) {
  param.group = group;
  return param;
}

}  // namespace accuray
