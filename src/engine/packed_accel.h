// The intersector of small scenes: all triangles, eight at a time, with no acceleration structure at all.
//
// A Cornell box has 36 triangles. Testing them in five rounds of AVX2 takes less time than a walk through a tree
// (measured on the box with blocks, Zen 3: see docs/design/0002), so scenes of a few dozen triangles use this instead
// of Embree. It is as watertight: an edge shared by two triangles gives the same value with opposite sign.
#pragma once

#include <immintrin.h>

#include <vector>

#include "kernels/geometry/intersect.h"

namespace accuray {

class PackedScene {
 public:
  // Scenes beyond these bounds, or with instances or meshes that deform, are Embree's.
  static constexpr uint32_t most_triangles = 64;
  static constexpr uint32_t most_analytic = 4;

  static bool suits(const SceneView& view);
  explicit PackedScene(const SceneView& view);

  Hit closest(const Ray& ray) const {
    const Broadcast r(ray);
    __m256 best_t = _mm256_set1_ps(ray.far);
    __m256 best_u = _mm256_setzero_ps();
    __m256 best_v = _mm256_setzero_ps();
    __m256 best_sum = _mm256_set1_ps(1.0f);
    __m256i best_group = _mm256_set1_epi32(-1);
    for (size_t g = 0; g < groups_.size(); ++g) {
      const Met met = meet(groups_[g], r, best_t);
      best_t = _mm256_blendv_ps(best_t, met.t, met.valid);
      best_u = _mm256_blendv_ps(best_u, met.u, met.valid);
      best_v = _mm256_blendv_ps(best_v, met.v, met.valid);
      best_sum = _mm256_blendv_ps(best_sum, met.sum, met.valid);
      best_group = _mm256_castps_si256(_mm256_blendv_ps(
          _mm256_castsi256_ps(best_group), _mm256_castsi256_ps(_mm256_set1_epi32(static_cast<int>(g))), met.valid));
    }
    Hit hit =
        nearest_lane(best_t, _mm256_div_ps(best_u, best_sum), _mm256_div_ps(best_v, best_sum), best_group, ray.far);
    for (const uint32_t geometry : analytic_) {
      const float t = meet_analytic(geometry, ray, hit.t);
      if (t > 0.0f) hit = {t, 0.0f, 0.0f, 0, geometry, none};
    }
    return hit;
  }

  bool occluded(const Ray& ray) const {
    const Broadcast r(ray);
    const __m256 far = _mm256_set1_ps(ray.far);
    for (const Group& group : groups_) {
      if (_mm256_movemask_ps(meet(group, r, far).valid) != 0) return true;
    }
    for (const uint32_t geometry : analytic_) {
      if (meet_analytic(geometry, ray, ray.far) > 0.0f) return true;
    }
    return false;
  }

 private:
  // Eight triangles: vertices, edges and normals, a register for each coordinate. Unused lanes have zero normals, so no
  // ray meets them.
  struct alignas(32) Group {
    float p0[3][8], p1[3][8], p2[3][8];
    float ac[3][8], ba[3][8], cb[3][8];  // p0 - p2, p1 - p0, p2 - p1
    float normal[3][8];
    uint32_t geometry[8], primitive[8];
  };

  struct Three {
    __m256 x, y, z;
  };
  struct Broadcast {
    explicit Broadcast(const Ray& ray)
        : origin{_mm256_set1_ps(ray.origin.x), _mm256_set1_ps(ray.origin.y), _mm256_set1_ps(ray.origin.z)},
          direction{_mm256_set1_ps(ray.direction.x), _mm256_set1_ps(ray.direction.y), _mm256_set1_ps(ray.direction.z)} {
    }
    Three origin, direction;
  };
  // u and v are barycentric coordinates times `sum`.
  struct Met {
    __m256 t, u, v, sum, valid;
  };

  static Three load(const float (&v)[3][8]) {
    return {_mm256_load_ps(v[0]), _mm256_load_ps(v[1]), _mm256_load_ps(v[2])};
  }
  static Three add(Three a, Three b) {
    return {_mm256_add_ps(a.x, b.x), _mm256_add_ps(a.y, b.y), _mm256_add_ps(a.z, b.z)};
  }
  static Three subtract(Three a, Three b) {
    return {_mm256_sub_ps(a.x, b.x), _mm256_sub_ps(a.y, b.y), _mm256_sub_ps(a.z, b.z)};
  }
  static __m256 dot(Three a, Three b) {
    return _mm256_fmadd_ps(a.x, b.x, _mm256_fmadd_ps(a.y, b.y, _mm256_mul_ps(a.z, b.z)));
  }
  static Three cross(Three a, Three b) {
    return {_mm256_fmsub_ps(a.y, b.z, _mm256_mul_ps(a.z, b.y)), _mm256_fmsub_ps(a.z, b.x, _mm256_mul_ps(a.x, b.z)),
            _mm256_fmsub_ps(a.x, b.y, _mm256_mul_ps(a.y, b.x))};
  }

  // The test of intersect_triangle() in kernels/geometry/intersect.h; valid where t is in (0, far).
  static Met meet(const Group& group, const Broadcast& ray, __m256 far) {
    const Three a = subtract(load(group.p0), ray.origin);
    const Three b = subtract(load(group.p1), ray.origin);
    const Three c = subtract(load(group.p2), ray.origin);
    // The cross product takes the sum first: its rounding then negates exactly when the edge is walked the other way.
    const __m256 u = dot(cross(add(c, a), load(group.ac)), ray.direction);
    const __m256 v = dot(cross(add(a, b), load(group.ba)), ray.direction);
    const __m256 w = dot(cross(add(b, c), load(group.cb)), ray.direction);
    const __m256 zero = _mm256_setzero_ps();
    const __m256 low = _mm256_min_ps(u, _mm256_min_ps(v, w));
    const __m256 high = _mm256_max_ps(u, _mm256_max_ps(v, w));
    const __m256 inside = _mm256_or_ps(_mm256_cmp_ps(low, zero, _CMP_GE_OQ), _mm256_cmp_ps(high, zero, _CMP_LE_OQ));
    const Three normal = load(group.normal);
    const __m256 approach = dot(normal, ray.direction);
    const __m256 t = _mm256_div_ps(dot(normal, a), approach);
    const __m256 in_range = _mm256_and_ps(_mm256_cmp_ps(t, zero, _CMP_GT_OQ), _mm256_cmp_ps(t, far, _CMP_LT_OQ));
    const __m256 sum = _mm256_add_ps(u, _mm256_add_ps(v, w));
    const __m256 usable = _mm256_cmp_ps(sum, zero, _CMP_NEQ_OQ);
    return {t, u, v, sum, _mm256_and_ps(inside, _mm256_and_ps(in_range, usable))};
  }

  Hit nearest_lane(__m256 t, __m256 u, __m256 v, __m256i group, float far) const;
  float meet_analytic(uint32_t geometry, const Ray& ray, float far) const;

  SceneView view_;
  std::vector<Group> groups_;
  std::vector<uint32_t> analytic_;
};

}  // namespace accuray
