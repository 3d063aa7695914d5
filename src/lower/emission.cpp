#include "lower/emission.h"

#include <algorithm>
#include <map>

#include "kernels/light/emission.h"

namespace accuray {

namespace {

// Points in all, and for one light.
constexpr uint32_t kMostPoints = 1u << 20;
constexpr uint32_t kLeastOfLight = 4;
constexpr uint32_t kMostOfLight = 4096;

constexpr double kCommonShare = 1.0 / 16.0;

double brightness(TextureValue rgb) {
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) sum += std::max(static_cast<double>(rgb[k]), 0.0);
  return sum / 3.0;
}

// Mean of a texture over a light, by area, from `count` Hammersley points.
double mean_over(const SceneView& scene, uint32_t light, uint32_t texture, uint32_t count) {
  const LightRecord& record = scene.lights[light];
  return dispatch(Lights{}, record.light.tag, [&](auto type) {
    using L = typename decltype(type)::type;
    double sum = 0.0;
    if constexpr (requires(const L& l) { l.at(Vec2{}); }) {
      for (uint32_t i = 0; i < count; ++i) {
        const Vec2 u = {(static_cast<float>(i) + 0.5f) / static_cast<float>(count),
                        static_cast<float>(reverse_bits(i) >> 8) * 0x1p-24f};
        Vec3 point = scene.as<L>(record.light).at(u);
        if (record.motion != none) point = transform_at(moment_of(scene, record.motion, 0.0f)).point(point);
        sum += brightness(texture_value(scene, texture, point_on_light(scene, light, point, 0.0f)));
      }
    }
    return sum / count;
  });
}

}  // namespace

std::vector<double> texture_shares(const SceneView& scene, uint32_t lights) {
  struct Sum {
    double mean = 0.0;
    uint32_t count = 0;
  };
  std::map<uint32_t, Sum> by_emission;
  const auto emission = [&](uint32_t i) { return scene.lights[i].emission.index; };
  const auto is_textured_surface = [&](uint32_t i) {
    return is_textured(scene.spectra[emission(i)].form) && !is_infinite_light(scene.lights[i].light.tag);
  };
  for (uint32_t i = 0; i < lights; ++i) {
    if (is_textured_surface(i)) ++by_emission[emission(i)].count;
  }
  std::vector<double> shares(lights, 1.0);
  for (uint32_t i = 0; i < lights; ++i) {
    if (!is_textured_surface(i)) continue;
    Sum& sum = by_emission[emission(i)];
    const uint32_t points = std::clamp(kMostPoints / sum.count, kLeastOfLight, kMostOfLight);
    shares[i] = mean_over(scene, i, scene.spectra[emission(i)].count, points);
    sum.mean += shares[i] / sum.count;
  }
  for (uint32_t i = 0; i < lights; ++i) {
    const auto found = by_emission.find(emission(i));
    if (found == by_emission.end() || !is_textured_surface(i)) continue;
    const double common = found->second.mean > 0.0 ? found->second.mean : 1.0;
    shares[i] = (1.0 - kCommonShare) * shares[i] + kCommonShare * common;
  }
  return shares;
}

}  // namespace accuray
