// The intersector of this machine: Embree over the lowered scene, whose vertex and index bytes it reads in place.
// Scenes of a few dozen triangles are tested without it: see packed_accel.h.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "engine/embree_shim.h"
#include "engine/packed_accel.h"
#include "kernels/accel/accel.h"

namespace accuray {

struct EmbreeError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Embree itself, and how much memory its structures take. Scenes that share parts share it.
struct EmbreeDevice {
  EmbreeDevice();
  ~EmbreeDevice();
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;

  RTCDevice handle;
  size_t bytes = 0;
};

// The structure over what instances show.
struct EmbreePrototype {
  EmbreePrototype(std::shared_ptr<EmbreeDevice> owner, RTCScene made) : device(std::move(owner)), scene(made) {}
  ~EmbreePrototype() { rtcReleaseScene(scene); }
  EmbreePrototype(const EmbreePrototype&) = delete;
  EmbreePrototype& operator=(const EmbreePrototype&) = delete;

  std::shared_ptr<EmbreeDevice> device;
  RTCScene scene;
};

// Owns Embree's structures for one scene. The view's sections must outlive it.
//
// The build must not depend on the number of threads: where two triangles are met at the same distance, their order in
// a leaf decides which one is the hit, and Embree's parallel partition orders a leaf by the number of tasks. So it
// builds with one thread.
class EmbreeScene {
 public:
  // `before`: an earlier frame, whose prototypes are used where their meshes lie in the same sections.
  explicit EmbreeScene(const SceneView& view, const EmbreeScene* before = nullptr);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene scene() const { return scene_; }
  // The whole scene in packed form; null if it is too large for that.
  const PackedScene* packed() const { return packed_.get(); }
  uint32_t first_instance() const { return first_instance_; }
  const SceneView& view() const { return view_; }
  size_t bytes() const { return device_ == nullptr ? 0 : device_->bytes; }
  uint32_t built_prototypes() const { return built_prototypes_; }

  // What a user geometry's callback finds behind its pointer.
  struct Analytic {
    const SceneView* view;
    uint32_t geometry;
  };

 private:
  RTCGeometry make_geometry(uint32_t number);
  void attach(RTCScene target, uint32_t number, uint32_t id);
  // Where the arrays of some meshes lie; empty if one of them is no mesh.
  using Place = std::vector<std::pair<const void*, uint64_t>>;
  Place place_of(uint32_t first, uint32_t count) const;
  RTCScene prototype_scene(uint32_t first, uint32_t count, const EmbreeScene* before);
  void place(RTCGeometry instance, const InstanceRecord& record) const;
  void attach_instances(const EmbreeScene* before);
  void commit(RTCScene target);
  void check(const char* action);

  SceneView view_;
  std::shared_ptr<EmbreeDevice> device_;
  RTCScene scene_ = nullptr;
  std::vector<std::shared_ptr<EmbreePrototype>> prototypes_;
  std::map<Place, std::shared_ptr<EmbreePrototype>> placed_;
  uint32_t built_prototypes_ = 0;
  std::vector<std::unique_ptr<Analytic>> analytic_;
  std::unique_ptr<PackedScene> packed_;
  uint32_t first_instance_;
};

// What kernels see; one for each thread, because it counts.
class EmbreeAccel {
 public:
  explicit EmbreeAccel(const EmbreeScene& scene) : scene_(&scene), packed_(scene.packed()) {}

  Hit closest(const Ray& ray) const {
    ++rays_;
    if (packed_ != nullptr) return packed_->closest(ray);
    if (!is_traceable(ray)) return Hit{};
    alignas(16) RTCRayHit rh;
    embree::prepare(rh);
    load(rh.ray, ray);
    embree::intersect(scene_->scene(), &rh);
    if (rh.hit.geomID == RTC_INVALID_GEOMETRY_ID) return Hit{};
    Hit hit{rh.ray.tfar, rh.hit.u, rh.hit.v, rh.hit.primID, rh.hit.geomID, none};
    if (rh.hit.instID[0] != RTC_INVALID_GEOMETRY_ID) {
      hit.instance = rh.hit.instID[0] - scene_->first_instance();
      hit.geometry = scene_->view().instances[hit.instance].first + rh.hit.geomID;
    }
    return hit;
  }

  float transmittance(const Ray& ray) const {
    ++rays_;
    if (packed_ != nullptr) return packed_->occluded(ray) ? 0.0f : 1.0f;
    if (!is_traceable(ray)) return 0.0f;
    alignas(16) RTCRay r;
    r.tnear = 0.0f;
    r.mask = 0xffffffffu;
    r.id = 0;
    r.flags = 0;
    load(r, ray);
    embree::occluded(scene_->scene(), &r);
    return r.tfar < 0.0f ? 0.0f : 1.0f;
  }

  uint64_t rays() const { return rays_; }

 private:
  // Embree must not be given coordinates beyond its limit of 1.8e18, nor NaN: some builds of it abort.
  static bool is_traceable(const Ray& ray) {
    constexpr float limit = 1e18f;
    const Vec3 o = abs(ray.origin);
    const Vec3 d = abs(ray.direction);
    return (o.x < limit) & (o.y < limit) & (o.z < limit) & (d.x < limit) & (d.y < limit) & (d.z < limit);
  }
  static void load(RTCRay& target, const Ray& ray) {
    target.org_x = ray.origin.x;
    target.org_y = ray.origin.y;
    target.org_z = ray.origin.z;
    target.dir_x = ray.direction.x;
    target.dir_y = ray.direction.y;
    target.dir_z = ray.direction.z;
    target.tfar = ray.far;
    target.time = ray.time;
  }

  const EmbreeScene* scene_;
  const PackedScene* packed_;
  mutable uint64_t rays_ = 0;
};

static_assert(Accel<EmbreeAccel>);

}  // namespace accuray
