// The scene's triangles in Embree, built in ways that AccuRay itself does not use.
#pragma once

#include "engine/embree_shim.h"
#include "kernels/geometry/shapes.h"

namespace accuray::bench {

struct BareOptions {
  const char* device;  // Embree's configuration string
  bool robust;
  bool compact;
  RTCBuildQuality quality;
};

// Meshes only: throws std::runtime_error for a scene with anything else. The view's sections must outlive it.
class BareScene {
 public:
  BareScene(const SceneView& view, const BareOptions& options);
  ~BareScene();
  BareScene(const BareScene&) = delete;
  BareScene& operator=(const BareScene&) = delete;

  RTCScene scene() const { return scene_; }

 private:
  void attach(const SceneView& view, uint32_t geometry);

  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace accuray::bench
