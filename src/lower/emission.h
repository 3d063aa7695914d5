// How bright textured lights are, for choosing among them.
#pragma once

#include <vector>

#include "kernels/scene_view.h"

namespace accuray {

// For each of the scene's first `lights` lights the mean over its surface of the texture that gives its emission, 1 for
// the others. It is estimated from a fixed set of points and never 0: lights that share a texture have a sixteenth of
// their common mean besides, so what the points missed is found by rare samples that count more, without bias.
std::vector<double> texture_shares(const SceneView& scene, uint32_t lights);

}  // namespace accuray
