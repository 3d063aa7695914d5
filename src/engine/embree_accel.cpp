#include "engine/embree_accel.h"

#include <tbb/task_arena.h>

#include <map>
#include <utility>

#include "kernels/geometry/intersect.h"
#include "kernels/math/rounding.h"

namespace accuray {

namespace {

RTCBounds bounds_of(Vec3 center, float radius) {
  // A little more than the shape, so that rounding never cuts it.
  const float r = radius * (1.0f + gamma(8)) + gamma(8) * max_component(abs(center));
  return {center.x - r, center.y - r, center.z - r, 0, center.x + r, center.y + r, center.z + r, 0};
}

template <class F>
auto with_shape(const EmbreeScene::Analytic& analytic, F&& f) {
  const Tagged shape = analytic.view->geometries[analytic.geometry].shape;
  return shape.tag == tag_of<Sphere>(Shapes{}) ? f(analytic.view->as<Sphere>(shape))
                                               : f(analytic.view->as<Disk>(shape));
}

void bounds_callback(const RTCBoundsFunctionArguments* arguments) {
  const auto& analytic = *static_cast<const EmbreeScene::Analytic*>(arguments->geometryUserPtr);
  *arguments->bounds_o = with_shape(analytic, [](const auto& shape) { return bounds_of(shape.center, shape.radius); });
}

// Nearest t of lane i's ray within (0, tfar], negative if there is none.
float meet(const EmbreeScene::Analytic& analytic, const RTCRay& ray) {
  const Ray r{{ray.org_x, ray.org_y, ray.org_z}, {ray.dir_x, ray.dir_y, ray.dir_z}, ray.tfar, ray.time};
  return with_shape(analytic, [&](const auto& shape) { return intersect(shape, r, ray.tfar); });
}

// Rays come one at a time: nothing here calls Embree's packet functions.
void intersect_callback(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  const auto& analytic = *static_cast<const EmbreeScene::Analytic*>(arguments->geometryUserPtr);
  auto& rh = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
  const float t = meet(analytic, rh.ray);
  if (!(t > 0.0f)) return;
  rh.ray.tfar = t;
  rh.hit.u = rh.hit.v = 0.0f;
  rh.hit.Ng_x = rh.hit.Ng_y = rh.hit.Ng_z = 0.0f;
  rh.hit.primID = 0;
  rh.hit.geomID = arguments->geomID;
  embree::set_instance(rh.hit, arguments->context);
}

void occluded_callback(const RTCOccludedFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  const auto& analytic = *static_cast<const EmbreeScene::Analytic*>(arguments->geometryUserPtr);
  auto& ray = *reinterpret_cast<RTCRay*>(arguments->ray);
  if (meet(analytic, ray) > 0.0f) ray.tfar = -infinity;
}

bool count_memory(void* total, ssize_t bytes, bool) {
  __atomic_fetch_add(static_cast<size_t*>(total), static_cast<size_t>(bytes), __ATOMIC_RELAXED);
  return true;
}

}  // namespace

EmbreeDevice::EmbreeDevice() : handle(rtcNewDevice("isa=avx2,frequency_level=simd256")) {
  if (handle == nullptr)
    throw EmbreeError("starting Embree: Embree error " + std::to_string(rtcGetDeviceError(nullptr)));
  rtcSetDeviceMemoryMonitorFunction(handle, count_memory, &bytes);
}

EmbreeDevice::~EmbreeDevice() { rtcReleaseDevice(handle); }

EmbreeScene::EmbreeScene(const SceneView& view, const EmbreeScene* before)
    : view_(view), first_instance_(view.root->top_geometries) {
  if (PackedScene::suits(view_)) {
    packed_ = std::make_unique<PackedScene>(view_);
    return;
  }
  if (before != nullptr) device_ = before->device_;
  if (device_ == nullptr) device_ = std::make_shared<EmbreeDevice>();
  scene_ = rtcNewScene(device_->handle);
  for (uint32_t g = 0; g < view_.root->top_geometries; ++g) attach(scene_, g, g);
  attach_instances(before);
  commit(scene_);
}

EmbreeScene::~EmbreeScene() {
  if (scene_ != nullptr) rtcReleaseScene(scene_);
}

void EmbreeScene::check(const char* action) {
  const RTCError error = rtcGetDeviceError(device_->handle);
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw EmbreeError(std::string(action) + ": out of memory");
  if (error != RTC_ERROR_NONE) throw EmbreeError(std::string(action) + ": Embree error " + std::to_string(error));
}

RTCGeometry EmbreeScene::make_geometry(uint32_t number) {
  const GeometryRecord& record = view_.geometries[number];
  if (record.shape.tag != tag_of<Mesh>(Shapes{})) {
    analytic_.push_back(std::make_unique<Analytic>(Analytic{&view_, number}));
    RTCGeometry geometry = rtcNewGeometry(device_->handle, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryUserData(geometry, analytic_.back().get());
    rtcSetGeometryBoundsFunction(geometry, [](const RTCBoundsFunctionArguments* a) { bounds_callback(a); }, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_callback);
    rtcSetGeometryOccludedFunction(geometry, occluded_callback);
    return geometry;
  }
  const Mesh& mesh = view_.as<Mesh>(record.shape);
  RTCGeometry geometry = rtcNewGeometry(device_->handle, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryTimeStepCount(geometry, mesh.segments + 1);
  for (uint32_t key = 0; key <= mesh.segments; ++key) {
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, key, RTC_FORMAT_FLOAT3, view_.at(mesh.vertices),
                               key * mesh.floats_per_key() * sizeof(float), mesh.stride * sizeof(float),
                               mesh.vertex_count);
  }
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, view_.at(mesh.indices), 0, 12,
                             mesh.indices.count / 3);
  return geometry;
}

void EmbreeScene::attach(RTCScene target, uint32_t number, uint32_t id) {
  RTCGeometry geometry = make_geometry(number);
  rtcSetGeometryMask(geometry, 0xffffffffu);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(target, geometry, id);
  rtcReleaseGeometry(geometry);
  check("adding a shape");
}

void EmbreeScene::commit(RTCScene target) {
  rtcSetSceneFlags(target,
                   view_.root->compact != 0 ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT : RTC_SCENE_FLAG_ROBUST);
  tbb::task_arena arena(1);
  arena.execute([&] { rtcCommitScene(target); });
  check("building the acceleration structure");
}

EmbreeScene::Place EmbreeScene::place_of(uint32_t first, uint32_t count) const {
  Place place;
  for (uint32_t g = first; g < first + count; ++g) {
    const Tagged shape = view_.geometries[g].shape;
    if (shape.tag != tag_of<Mesh>(Shapes{})) return {};
    const Mesh& mesh = view_.as<Mesh>(shape);
    place.emplace_back(view_.at(mesh.vertices), mesh.vertices.count);
    place.emplace_back(view_.at(mesh.indices), mesh.indices.count);
  }
  return place;
}

// One transform, or those of its keys: Embree moves between them in straight lines, as geometry/motion.h says.
void EmbreeScene::place(RTCGeometry instance, const InstanceRecord& record) const {
  if (record.motion == none) {
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, &record.to_world.m[0][0]);
    return;
  }
  const MotionRecord& motion = view_.motions[record.motion];
  rtcSetGeometryTimeStepCount(instance, motion.count);
  for (uint32_t k = 0; k < motion.count; ++k) {
    rtcSetGeometryTransform(instance, k, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, &view_.motion_keys[motion.first + k].m[0][0]);
  }
}

RTCScene EmbreeScene::prototype_scene(uint32_t first, uint32_t count, const EmbreeScene* before) {
  const Place place = place_of(first, count);
  std::shared_ptr<EmbreePrototype> prototype;
  if (before != nullptr && !place.empty()) {
    if (const auto found = before->placed_.find(place); found != before->placed_.end()) prototype = found->second;
  }
  if (prototype == nullptr) {
    prototype = std::make_shared<EmbreePrototype>(device_, rtcNewScene(device_->handle));
    for (uint32_t i = 0; i < count; ++i) attach(prototype->scene, first + i, i);
    commit(prototype->scene);
    ++built_prototypes_;
  }
  prototypes_.push_back(prototype);
  if (!place.empty()) placed_.emplace(place, prototype);
  return prototype->scene;
}

void EmbreeScene::attach_instances(const EmbreeScene* before) {
  std::map<std::pair<uint32_t, uint32_t>, RTCScene> made;
  for (uint32_t i = 0; i < view_.root->instances.count; ++i) {
    const InstanceRecord& record = view_.instances[i];
    RTCScene& prototype = made[{record.first, record.count}];
    if (prototype == nullptr) prototype = prototype_scene(record.first, record.count, before);
    RTCGeometry instance = rtcNewGeometry(device_->handle, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, prototype);
    place(instance, record);
    rtcSetGeometryMask(instance, 0xffffffffu);
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(scene_, instance, first_instance_ + i);
    rtcReleaseGeometry(instance);
  }
  check("adding instances");
}

}  // namespace accuray
