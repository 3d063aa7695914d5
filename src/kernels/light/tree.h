// A light tree: chooses among many lights by what each group of them may send to a point (Conty Estevez and Kulla 2018,
// "Importance Sampling of Many Lights with Adaptive Tree Splitting").
//
// Departures from the paper:
//   - A node has four children: one vector weighs them all, and a handful of lights is a single node.
//   - A group weighs by what it sends on the average, from the mean and the variance of its positions and normals (as
//     do Tokuyoshi et al. 2024 with spherical Gaussians), and not by the most that a box and a cone let it send. Bounds
//     only tell where nothing can arrive. With 10 000 lamps that is a thirteenth of the variance, at less cost.
//   - A group that looks large from the point weighs by its own children: see `wide`.
#pragma once

#include "kernels/math/constants.h"
#include "kernels/math/vec.h"
#include "kernels/sampling/hash.h"
#include "kernels/scene_view.h"
#include "kernels/spectrum/wavelengths.h"

namespace accuray {

namespace tree {

constexpr uint32_t is_light = 0x80000000u;  // in LightNode::child: the rest is a light, not a node
// Trails: two bits a level from the root's child downwards; of lights beside the tree this bit and a number.
constexpr uint32_t beside = 0x80000000u;
constexpr uint32_t most_levels = 15;

// How LightNode packs its numbers.
constexpr uint32_t coordinate_bits = 10;
constexpr uint32_t coordinate_mask = 1023;
constexpr float coordinate_step = 2.0f / 1022.0f;  // from -1; 0 is exact
constexpr uint32_t both_sides_bit = 31;            // of the axis
constexpr uint32_t radius_mask = 0xffff0000u;      // of the bound: a float with 7 bits of mantissa
constexpr uint32_t emission_mask = 255;
constexpr float emission_step = 1.0f / 128.0f;  // from -1

// What packing may do to a cosine.
constexpr float cosine_slack = 4e-3f;
// Bounds that keep weights normal numbers. Intensities are at most 1.
constexpr float least_squared = 1e-30f;
constexpr float least_weight = 1e-36f;
// The least share of a child that may send anything, and the chance below which the digits of u count as used up.
constexpr float least_share = 0x1p-20f;
constexpr float few_digits = 0x1p-10f;
// Variance of the positions over the squared distance from which a group counts as wide.
constexpr float wide = 0.1f;

inline f32x4 load(const float (&row)[4]) { return lanes(row[0], row[1], row[2], row[3]); }
inline u32x4 load(const uint32_t (&row)[4]) { return lanes_u(row[0], row[1], row[2], row[3]); }
inline f32x4 coordinate(u32x4 axis, uint32_t shift) {
  return fma(to_float((axis >> shift) & coordinate_mask), lanes(coordinate_step), lanes(-1.0f));
}
// Mean of max(x, 0) for x of mean `m` that varies: exact if x does not vary, or evenly around 0 with variance 4/3 v.
inline f32x4 mean_of_positive(f32x4 m, f32x4 v) { return 0.5f * (m + sqrt(fma(m, m, v))); }

struct Arriving {
  f32x4 weight;
  f32x4 width;  // variance of the positions over the squared distance
};

// What each child sends to a point, as irradiance: 0 only where nothing can arrive, below the horizon of `normal`
// (zero: there is none) or outside the emission. With v from the point to the middle of the lights, d = |v|, n the
// normals of point and lights, it is intensity (n.v / d)+ (n'.-v / d)+ / d^2, where means stand for the brackets and
// the mean square for d^2.
inline Arriving arriving(const LightNode& node, Vec3 point, Vec3 normal) {
  const f32x4 x = load(node.x) - point.x;
  const f32x4 y = load(node.y) - point.y;
  const f32x4 z = load(node.z) - point.z;
  const f32x4 squared = fma(x, x, fma(y, y, z * z));
  const f32x4 variance = load(node.variance);
  const f32x4 mean_square = max(squared + variance, lanes(least_squared));
  const u32x4 bound = load(node.bound);
  const f32x4 radius = float_of(bound & radius_mask);

  // Towards the point, by the lights' normals.
  const u32x4 axis = load(node.axis);
  const f32x4 ax = coordinate(axis, 0u);
  const f32x4 ay = coordinate(axis, coordinate_bits);
  const f32x4 az = coordinate(axis, 2u * coordinate_bits);
  const f32x4 alignment = fma(ax, ax, fma(ay, ay, az * az));
  const f32x4 facing = fma(ax, x, fma(ay, y, az * z)) * -1.0f;
  const f32x4 one_side = 1.0f - to_float(axis >> both_sides_bit);
  const f32x4 forth = select_greater(one_side, lanes(0.5f), facing, max(facing, -1.0f * facing));
  const f32x4 scatter = max(1.0f - alignment, lanes(0.0f)) * mean_square + alignment * variance;
  const f32x4 distance = sqrt(squared);
  const f32x4 leaving =
      max(mean_of_positive(forth, 0.25f * scatter), cosine_slack * distance) * fma(one_side, lanes(0.5f), lanes(0.5f));
  const f32x4 cos_emission = fma(to_float(bound & emission_mask), lanes(emission_step), lanes(-1.0f));

  // Onto the surface, by its normal.
  f32x4 falling = sqrt(mean_square);
  f32x4 above = lanes(1.0f);
  if (normal.x != 0.0f || normal.y != 0.0f || normal.z != 0.0f) {
    const f32x4 height = fma(lanes(normal.x), x, fma(lanes(normal.y), y, normal.z * z));
    falling = mean_of_positive(height, 0.25f * variance);
    above = fma(lanes(1e-6f), distance, height + radius);
  }
  const f32x4 inverse = 1.0f / mean_square;
  const f32x4 intensity = load(node.intensity);
  const f32x4 weight = max(intensity * (falling * inverse) * (leaving * inverse), lanes(least_weight));
  const f32x4 dark = fma(cos_emission - cosine_slack, distance, -1.0f * fma(radius, cos_emission, radius));
  const f32x4 lit = select_greater(forth, dark, weight, lanes(0.0f));
  const f32x4 seen = select_greater(above, lanes(0.0f), lit, lanes(0.0f));
  return {select_greater(intensity, lanes(0.0f), seen, lanes(0.0f)), variance / max(squared, lanes(least_squared))};
}

// By how much each child of a node weighs: as a whole, or if it is wide as the sum of its own children.
inline f32x4 weights(const SceneView& scene, const LightNode& node, Vec3 point, Vec3 normal) {
  const Arriving whole = arriving(node, point, normal);
  f32x4 weight = whole.weight;
  for (int k = 0; k < 4; ++k) {
    if ((node.child[k] & is_light) != 0 || !(whole.width[k] > wide) || whole.weight[k] == 0.0f) continue;
    weight[k] = sum(arriving(scene.light_nodes[node.child[k]], point, normal).weight);
  }
  return weight;
}

// Running sums over the four children, in proportion to which they are chosen. Where none can send anything, which the
// bounds of their parent did not show, they count by their intensity: the choice does not matter, but must be one.
struct Shares {
  f32x4 end;
  float total() const { return end[3]; }
  float begin(uint32_t k) const { return k == 0 ? 0.0f : (k == 1 ? end[0] : (k == 2 ? end[1] : end[2])); }
  float until(uint32_t k) const { return k == 0 ? end[0] : (k == 1 ? end[1] : (k == 2 ? end[2] : end[3])); }
  float probability(uint32_t k) const { return (until(k) - begin(k)) / total(); }
  // The child whose part of the sums holds x.
  uint32_t holding(float x) const {
    return (x >= end[0] ? 1u : 0u) + (x >= end[1] ? 1u : 0u) + (x >= end[2] ? 1u : 0u);
  }
};
inline Shares running_sums(f32x4 weights) {
  const float two = weights[0] + weights[1];
  const float three = two + weights[2];
  return {lanes(weights[0], two, three, three + weights[3])};
}
inline Shares shares_of(const SceneView& scene, const LightNode& node, Vec3 point, Vec3 normal) {
  const f32x4 weight = weights(scene, node, point, normal);
  const float total = running_sums(weight).total();
  if (total == 0.0f) [[unlikely]]
    return running_sums(load(node.intensity));
  return running_sums(select_greater(weight, lanes(0.0f), max(weight, lanes(least_share * total)), weight));
}

// Fresh digits for a number that has decided about rare things: a function of the number and of the point's digits
// without their exponents, so that the unit of length does not matter.
inline float fresh(float u, Vec3 point) {
  const auto digits = [](float x) { return bits_of(x) & 0x007fffffu; };
  return uniform(hash(hash(bits_of(u), digits(point.x)), digits(point.y), digits(point.z)));
}

}  // namespace tree

struct LightChoice {
  uint32_t light;  // none if the scene has no light
  float probability;
};

// A light of the tree, with a number u in [0, 1).
inline LightChoice choose_in_tree(const SceneView& scene, Vec3 point, Vec3 normal, float u) {
  float probability = 1.0f;
  float renewed = 1.0f;  // the probability at which u was last fresh
  uint32_t child = 0;
  while ((child & tree::is_light) == 0) {
    const LightNode& node = scene.light_nodes[child];
    const tree::Shares shares = tree::shares_of(scene, node, point, normal);
    const float x = u * shares.total();
    const uint32_t k = shares.holding(x);
    probability *= shares.probability(k);
    u = min((x - shares.begin(k)) / (shares.until(k) - shares.begin(k)), one_minus_epsilon);
    if (probability < tree::few_digits * renewed) {
      u = tree::fresh(u, point);
      renewed = probability;
    }
    child = node.child[k];
  }
  return {child & ~tree::is_light, probability};
}

// The probability with which choose_in_tree() chooses the light at the end of a trail: the same numbers, bit by bit.
inline float probability_in_tree(const SceneView& scene, Vec3 point, Vec3 normal, uint32_t trail) {
  float probability = 1.0f;
  uint32_t child = 0;
  while ((child & tree::is_light) == 0) {
    const LightNode& node = scene.light_nodes[child];
    const uint32_t k = trail & 3u;
    probability *= tree::shares_of(scene, node, point, normal).probability(k);
    child = node.child[k];
    trail >>= 2;
  }
  return probability;
}

}  // namespace accuray
