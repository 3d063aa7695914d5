// When the shutter lets light through: the time of each path.
#pragma once

#include "kernels/math/interval.h"
#include "kernels/scene_view.h"

namespace accuray {

// What the shutter lets through is a line between nodes in time. SceneView::shutter holds, for n nodes, their n times
// from 0 to 1, n shares of the light that came before, and n transmissions over their mean; nothing: it is wholly open
// all the time.

// The time in [0, 1] before which the share u of the light comes. Within an interval the share is a parabola; its root
// is the form that does not cancel where the line is level.
ACCURAY_NOINLINE inline float time_of_share(const SceneView& scene, float u) {
  const uint32_t nodes = scene.root->shutter.count / 3;
  const float* times = scene.shutter;
  const float* shares = times + nodes;
  const float* open = shares + nodes;
  const uint32_t k = interval_of(shares, nodes - 1, u);
  const float width = times[k + 1] - times[k];
  const float r = (u - shares[k]) / width;
  const float below = open[k] + sqrt(max(fma(open[k], open[k], 2.0f * (open[k + 1] - open[k]) * r), 0.0f));
  const float x = below > 0.0f ? min(2.0f * r / below, 1.0f) : 0.0f;
  return min(fma(x, width, times[k]), 1.0f);
}

// A path's time, with a number u in [0, 1): where much light comes there are many paths, each with weight 1.
inline float path_time(const SceneView& scene, float u) {
  if (scene.root->shutter.count != 0) [[unlikely]]
    return time_of_share(scene, u);
  return u;
}

}  // namespace accuray
