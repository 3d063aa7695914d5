#include "lower/lights.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

namespace accuray {

namespace {

Vec3 vertex(std::span<const float> positions, uint32_t index) { return load_vec3(positions.data(), index); }

// Sum of the three colour matching functions at 360 + i nm.
double response_at(const std::vector<double>& cmf, size_t i) { return cmf[3 * i] + cmf[3 * i + 1] + cmf[3 * i + 2]; }

// Four corners in order, if two triangles (a, b, c), (a, c, d) form a rectangle to within rounding.
bool is_rectangle(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a;
  const Vec3 v = d - a;
  const float size = length(u) + length(v);
  const float slack = 1e-6f * (size + max_component(abs(a)));
  if (!(length(u) > 16.0f * slack && length(v) > 16.0f * slack)) return false;
  const bool parallelogram = length((b + d) - (a + c)) <= 4.0f * slack;
  return parallelogram && std::fabs(dot(u, v)) <= 1e-6f * length(u) * length(v) + slack * size;
}

QuadLight quad_light(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  QuadLight quad{};
  const Vec3 u = b - a;
  const Vec3 v = d - a;
  quad.corner = a;
  quad.width = length(u);
  quad.height = length(v);
  quad.x = u * (1.0f / quad.width);
  quad.y = normalize(fma(-dot(v, quad.x), quad.x, v));
  quad.normal = normalize(cross(u, v));
  const Vec3 first = triangle_error({a, b, c, nullptr, nullptr, nullptr});
  const Vec3 second = triangle_error({a, c, d, nullptr, nullptr, nullptr});
  quad.error = {max(first.x, second.x), max(first.y, second.y), max(first.z, second.z)};
  return quad;
}

// The rectangle that two triangles, six indices, form: (a, b, c), (a, c, d) as a polygon is cut, or mirrored
// (a, c, b), (a, d, c), whose front side is that of a, d, c, b.
std::optional<QuadLight> rectangle_of(std::span<const float> positions, const uint32_t* i) {
  const bool cut = i[3] == i[0] && i[4] == i[2];
  const bool mirrored = i[3] == i[0] && i[5] == i[1];
  if (!cut && !mirrored) return std::nullopt;
  const Vec3 a = vertex(positions, i[0]);
  const Vec3 b = vertex(positions, cut ? i[1] : i[4]);
  const Vec3 c = vertex(positions, cut ? i[2] : i[1]);
  const Vec3 d = vertex(positions, cut ? i[5] : i[2]);
  if (!is_rectangle(a, b, c, d)) return std::nullopt;
  return quad_light(a, b, c, d);
}

}  // namespace

std::vector<uint32_t> LightTable::add_mesh(std::span<const float> positions, std::span<const uint32_t> indices,
                                           SpectrumRef emission, bool both_sides, LightPlace place, uint32_t motion) {
  const size_t triangles = indices.size() / 3;
  std::vector<uint32_t> light_of(triangles);
  for (size_t t = 0; t < triangles; ++t) {
    const uint32_t* i = &indices[3 * t];
    place.primitive = static_cast<uint32_t>(t);
    const Vec3 a = vertex(positions, i[0]);
    const Vec3 b = vertex(positions, i[1]);
    const Vec3 c = vertex(positions, i[2]);
    if (t + 1 < triangles) {
      if (const std::optional<QuadLight> quad = rectangle_of(positions, i)) {
        light_of[t] = light_of[t + 1] = add(*quad, emission, both_sides, place, {}, motion);
        ++t;
        continue;
      }
    }
    const Vec3 normal = cross(b - a, c - a);
    const TriangleLight light{
        a, b, c, normalize(normal), triangle_error({a, b, c, nullptr, nullptr, nullptr}), 0.5f * length(normal)};
    light_of[t] = add(light, emission, both_sides, place, {}, motion);
  }
  return light_of;
}

bool LightTable::any_textured() const {
  return std::any_of(records_.begin(), records_.end(),
                     [&](const LightRecord& record) { return spectra_.is_textured(record.emission); });
}

// fn of the light itself.
template <class Fn>
auto LightTable::with_light(const LightRecord& record, Fn&& fn) const {
  return dispatch(Lights{}, record.light.tag, [&](auto type) {
    return fn(*reinterpret_cast<const typename decltype(type)::type*>(pool_.words().data() + record.light.offset));
  });
}

double LightTable::power_factor(const LightRecord& record, float scene_radius) const {
  const float factor = with_light(record, [&](const auto& light) { return light.power_per_radiance(scene_radius); });
  const double size = record.motion == none ? 1.0 : motions_.area_factor(record.motion);
  return static_cast<double>(factor) * size * (record.both_sides != 0 ? 2.0 : 1.0);
}

std::vector<double> LightTable::weights(float scene_radius) const {
  // Emission as the sensor sees it, once per spectrum.
  const std::vector<double>& cmf = spectra_.colour().cmf;
  std::vector<double> seen(spectra_.records().size(), -1.0);
  std::vector<double> result;
  for (const LightRecord& record : records_) {
    double& value = seen[record.emission.index];
    if (value < 0.0) {
      value = 0.0;
      for (uint32_t i = 0; i < lambda_nodes; ++i) {
        value += spectra_.value(record.emission, 360.0 + i) * response_at(cmf, i);
      }
    }
    const double share = shares_.empty() ? 1.0 : shares_[result.size()];
    result.push_back(value * share * power_factor(record, scene_radius));
  }
  return result;
}

namespace {

std::vector<float> running_sums(const std::vector<double>& weights) {
  double total = 0.0;
  for (const double w : weights) total += w;
  std::vector<float> cdf{0.0f};
  double sum = 0.0;
  for (size_t i = 0; i < weights.size(); ++i) {
    sum += total > 0.0 ? weights[i] / total : 1.0 / static_cast<double>(weights.size());
    cdf.push_back(i + 1 == weights.size() ? 1.0f : static_cast<float>(sum));
  }
  return cdf;
}

}  // namespace

LightTree LightTable::tree(float scene_radius) const {
  const std::vector<double> power = weights(scene_radius);
  std::vector<Emitter> near;
  std::vector<DistantEmitter> distant;
  for (uint32_t i = 0; i < records_.size(); ++i) {
    if (!(power[i] > 0.0)) continue;
    with_light(records_[i], [&](const auto& light) {
      if constexpr (std::remove_cvref_t<decltype(light)>::infinite) {
        // Seen from all sides alike; the flux into the sphere around the scene, spread over the sphere.
        const double radius = scene_radius;
        distant.push_back({i, power[i] / (4.0 * static_cast<double>(pi) * radius * radius)});
      } else {
        const uint32_t motion = records_[i].motion;
        const LightBounds bounds = motion == none ? light.bounds() : motions_.swept(motion, light.bounds());
        near.push_back({i, bounds, power[i], records_[i].both_sides != 0});
      }
      return true;
    });
  }
  return build_light_tree(near, distant, records_.size());
}

std::vector<float> LightTable::lambda_cdf(float scene_radius) const {
  const std::vector<double>& cmf = spectra_.colour().cmf;
  const std::vector<double> power = weights(scene_radius);
  double total = 0.0;
  for (const double p : power) total += p;

  // Emission of the scene: half in proportion to power, half with an equal say for every spectrum, so that a dim lamp
  // with lines of its own is not starved.
  std::vector<double> share(spectra_.records().size(), 0.0);
  std::vector<bool> used(spectra_.records().size(), false);
  size_t kinds = 0;
  for (size_t i = 0; i < records_.size(); ++i) {
    const uint32_t s = records_[i].emission.index;
    if (power[i] > 0.0) share[s] += power[i] / total;
    if (!used[s] && power[i] > 0.0) {
      used[s] = true;
      ++kinds;
    }
  }
  std::vector<double> cells(lambda_cells, 0.0);
  for (uint32_t s = 0; s < share.size(); ++s) {
    if (!used[s]) continue;
    std::vector<double> product(lambda_cells);
    double sum = 0.0;
    for (uint32_t i = 0; i < lambda_cells; ++i) {
      // The largest of the cell's ends and middle: no cell that holds a line gets nothing.
      double emission = 0.0;
      for (int k = 0; k <= 8; ++k) emission = std::max(emission, spectra_.value({s}, 360.0 + i + 0.125 * k));
      const double response = 0.5 * (response_at(cmf, i) + response_at(cmf, i + 1));
      // The root spreads the samples more evenly than the product itself: a third less colour noise with four
      // wavelengths, because the red and blue responses of RGB peak where the product is small.
      product[i] = sqrt(emission * response);
      sum += product[i];
    }
    const double weight = 0.5 * share[s] + 0.5 / static_cast<double>(kinds);
    for (uint32_t i = 0; i < lambda_cells; ++i) cells[i] += sum > 0.0 ? weight * product[i] / sum : 0.0;
  }
  if (kinds == 0) {
    for (uint32_t i = 0; i < lambda_cells; ++i) cells[i] = response_at(cmf, i);
  }
  return running_sums(cells);
}

std::vector<uint32_t> lambda_guide(const std::vector<float>& cdf) {
  std::vector<uint32_t> guide(lambda_guide_size);
  uint32_t cell = 0;
  for (uint32_t i = 0; i < lambda_guide_size; ++i) {
    const float u = static_cast<float>(i) / static_cast<float>(lambda_guide_size);
    while (cell + 1 < lambda_cells && cdf[cell + 1] <= u) ++cell;
    guide[i] = cell;
  }
  return guide;
}

}  // namespace accuray
