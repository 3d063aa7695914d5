// A block together with what Embree built over its shapes.
#pragma once

#include <memory>
#include <stdexcept>

#include "engine/embree_accel.h"
#include "lower/block.h"

namespace accuray::bindings {

// An acceleration structure with the sections that it reads: those of the block that it was first built for.
struct BuiltShapes {
  explicit BuiltShapes(const Block& lowered) : block(lowered), accel(block.view()) {}
  Block block;
  EmbreeScene accel;
};

struct LoadedScene {
  explicit LoadedScene(const Block& lowered) : LoadedScene(lowered, std::make_shared<const BuiltShapes>(lowered)) {}
  // `other` shows the same shapes, bit for bit, with whatever materials, lights and view.
  LoadedScene(const Block& lowered, const LoadedScene& other) : LoadedScene(lowered, other.shapes) {
    const Root& mine = *view.root;
    const Root& theirs = *other.view.root;
    if (mine.geometries.count != theirs.geometries.count || mine.top_geometries != theirs.top_geometries ||
        mine.instances.count != theirs.instances.count) {
      throw std::invalid_argument("the scenes do not have the same shapes");
    }
  }

  Block block;
  SceneView view;
  std::shared_ptr<const BuiltShapes> shapes;
  const EmbreeScene& accel;

 private:
  LoadedScene(const Block& lowered, std::shared_ptr<const BuiltShapes> built)
      : block(lowered), view(block.view()), shapes(std::move(built)), accel(shapes->accel) {}
};

}  // namespace accuray::bindings
