#include "replay/bare_scene.h"

#include <stdexcept>
#include <string>

namespace accuray::bench {

BareScene::BareScene(const SceneView& view, const BareOptions& options)
    : device_(rtcNewDevice(options.device)), scene_(rtcNewScene(device_)) {
  if (view.root->instances.count != 0) throw std::runtime_error("the bare loops trace scenes without instances only");
  for (uint32_t g = 0; g < view.root->top_geometries; ++g) attach(view, g);
  const int flags = (options.robust ? RTC_SCENE_FLAG_ROBUST : 0) | (options.compact ? RTC_SCENE_FLAG_COMPACT : 0);
  rtcSetSceneFlags(scene_, static_cast<RTCSceneFlags>(flags));
  rtcSetSceneBuildQuality(scene_, options.quality);
  rtcCommitScene(scene_);
  const RTCError error = rtcGetDeviceError(device_);
  if (error != RTC_ERROR_NONE) throw std::runtime_error("Embree error " + std::to_string(error));
}

BareScene::~BareScene() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void BareScene::attach(const SceneView& view, uint32_t number) {
  const GeometryRecord& record = view.geometries[number];
  if (record.shape.tag != tag_of<Mesh>(Shapes{})) {
    throw std::runtime_error("the bare loops trace scenes of meshes only");
  }
  const Mesh& mesh = view.as<Mesh>(record.shape);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, view.at(mesh.vertices), 0,
                             mesh.stride * sizeof(float), mesh.vertex_count);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, view.at(mesh.indices), 0, 12,
                             mesh.indices.count / 3);
  rtcSetGeometryMask(geometry, 0xffffffffu);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_, geometry, number);
  rtcReleaseGeometry(geometry);
}

}  // namespace accuray::bench
