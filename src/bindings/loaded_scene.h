// A block together with what Embree built over its shapes.
#pragma once

#include <memory>
#include <stdexcept>

#include "engine/embree_accel.h"
#include "lower/block.h"

namespace accuray::bindings {

// An acceleration structure with the sections that it reads: those of the block that it was first built for.
struct BuiltShapes {
  BuiltShapes(const Block& lowered, const BuiltShapes* before)
      : block(lowered), accel(block.view(), before == nullptr ? nullptr : &before->accel) {}
  Block block;
  EmbreeScene accel;
};

struct LoadedScene {
  // `before`: an earlier frame, parts of whose structure may serve; null: none.
  LoadedScene(const Block& lowered, const LoadedScene* before)
      : LoadedScene(lowered,
                    std::make_shared<const BuiltShapes>(lowered, before == nullptr ? nullptr : before->shapes.get())) {}
  // `other` shows the same shapes, bit for bit, with whatever materials, lights and view.
  static LoadedScene with_shapes_of(const LoadedScene& other, const Block& lowered) {
    LoadedScene scene(lowered, other.shapes);
    const Root& mine = *scene.view.root;
    const Root& theirs = *other.view.root;
    if (mine.geometries.count != theirs.geometries.count || mine.top_geometries != theirs.top_geometries ||
        mine.instances.count != theirs.instances.count) {
      throw std::invalid_argument("the scenes do not have the same shapes");
    }
    return scene;
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
