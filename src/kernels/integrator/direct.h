// Emission and direct light only: path tracing that stops at the first vertex, which it is lowered to.
#pragma once

#include "kernels/integrator/path.h"

namespace accuray {

struct DirectLighting {
  Strategy strategy;

  static constexpr const char* name = "direct";
  static constexpr const char* doc = "Emission and direct light: paths of one scattering event.";
  static constexpr auto params() {
    return param_list(Param{.name = "strategy",
                            .kind = Kind::choice,
                            .doc = "As for path.",
                            .preset = "\"mis\"",
                            .choices = "mis|light|bsdf",
                            .member = ACCURAY_OFFSET_OF(DirectLighting, strategy)});
  }
  PathTracing as_path() const { return {1, 0, 2, strategy}; }
};

}  // namespace accuray
