#include "lower/motion.h"

#include <stdexcept>

namespace accuray {

namespace {

// Lights whose normal keeps this cosine to that of the first key count as not turning.
constexpr float kSameDirection = 1.0f - 1e-6f;

// Rays are carried into the prototypes' own space, where Embree's limit of 1.8e18 holds too.
bool is_moderate(const Matrix& m) {
  const double volume = std::fabs(determinant(m));
  bool moderate = volume > 1e-45;
  for (const double entry : m) moderate = moderate && std::fabs(entry) < 1e15;
  return moderate;
}

}  // namespace

uint32_t MotionPool::add(std::span<const Matrix> keys) {
  if (keys.size() < 2 || keys.size() > most_motion_keys) throw std::invalid_argument("a motion has 2 to 129 keys");
  for (const Matrix& key : keys) {
    if (!is_moderate(key)) {
      throw std::invalid_argument("transform moves or scales by more than 1e15 or less than 1e-15");
    }
  }
  records_.push_back({static_cast<uint32_t>(keys_.size()), static_cast<uint32_t>(keys.size())});
  for (const Matrix& key : keys) {
    keys_.push_back(to_transform(key));
    matrices_.push_back(key);
  }
  return static_cast<uint32_t>(records_.size() - 1);
}

std::span<const Matrix> MotionPool::matrices_of(uint32_t motion) const {
  const MotionRecord& record = records_.at(motion);
  return std::span(matrices_).subspan(record.first, record.count);
}

Bounds MotionPool::swept(uint32_t motion, const Bounds& box) const {
  Bounds all;
  for (const Matrix& key : matrices_of(motion)) all.grow(box.moved(key));
  return all;
}

LightBounds MotionPool::swept(uint32_t motion, const LightBounds& light) const {
  const Bounds box = swept(motion, Bounds{light.low, light.high});
  LightBounds all = light;
  all.low = box.low;
  all.high = box.high;
  const auto axis_at = [&](const Matrix& key) {
    return normalize(to_vec3(transform_vector(normal_matrix(key), {light.axis.x, light.axis.y, light.axis.z})));
  };
  const std::span<const Matrix> keys = matrices_of(motion);
  all.axis = axis_at(keys.front());
  for (const Matrix& key : keys) {
    if (!(dot(all.axis, axis_at(key)) > kSameDirection)) all.cos_spread = -1.0f;
  }
  return all;
}

double MotionPool::area_factor(uint32_t motion) const {
  double most = 0.0;
  for (const Matrix& key : matrices_of(motion)) most = std::max(most, std::cbrt(std::fabs(determinant(key))));
  return most * most;
}

}  // namespace accuray
