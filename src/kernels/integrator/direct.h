// Emission and direct light only: path tracing that stops at the first vertex.
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
  DirectLighting direct_part() const { return *this; }

  template <Accel A>
  void trace(const SceneView& scene, const A& accel, Path& path) const {
    PathTracing{1, 0, 2, strategy}.trace(scene, accel, path);
  }
};

}  // namespace accuray
