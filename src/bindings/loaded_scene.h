// A block together with what Embree built over it.
#pragma once

#include "engine/embree_accel.h"
#include "lower/block.h"

namespace accuray::bindings {

struct LoadedScene {
  explicit LoadedScene(const Block& lowered) : block(lowered), accel(block.view()) {}
  Block block;
  EmbreeScene accel;
};

}  // namespace accuray::bindings
