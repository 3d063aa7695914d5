#include "lower/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "kernels/light/tree.h"

namespace accuray {

namespace {

constexpr size_t kBins = 16;
constexpr size_t kWidth = 4;

using Point = std::array<double, 3>;

double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point difference(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double distance(const Point& a, const Point& b) { return sqrt(dot(difference(a, b), difference(a, b))); }
Point point_of(Vec3 v) { return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)}; }
void add(double scale, const Point& p, Point& sum) {
  for (size_t axis = 0; axis < 3; ++axis) sum[axis] += scale * p[axis];
}

// A light or a group of lights: means by power, and bounds.
struct Group {
  double power = 0.0;
  Point middle{};
  double variance = 0.0;  // mean square of the distance from the middle
  double radius = 0.0;    // of a sphere around the middle that holds them
  Point normal{};         // mean of the unit normals; zero also stands for all directions alike
  double cos_emission = -1.0;
  bool both_sides = false;
  double gain = 1.0;  // of the intensity over that of a light that emits to a whole hemisphere
  uint32_t child = 0;
};

// Flat lights and narrow cones keep their axis; what emits to more than a hemisphere counts as emitting to all sides.
Group single(const Emitter& emitter) {
  const LightBounds& b = emitter.bounds;
  const Point low = point_of(b.low);
  const Point high = point_of(b.high);
  const Point size = difference(high, low);
  Group g;
  g.power = emitter.power;
  for (size_t axis = 0; axis < 3; ++axis) g.middle[axis] = 0.5 * (low[axis] + high[axis]);
  g.variance = dot(size, size) / 12.0;
  g.radius = 0.5 * sqrt(dot(size, size));
  g.child = emitter.light | tree::is_light;
  if (!(is_finite(b.axis) && b.cos_spread > 0.999f && b.cos_emission >= 0.0f)) return g;
  g.normal = point_of(b.axis);
  g.both_sides = emitter.both_sides;
  if (g.both_sides) return g;
  g.cos_emission = static_cast<double>(b.cos_emission);
  g.gain = 1.0 / std::max(1.0 - g.cos_emission * g.cos_emission, 1e-4);
  return g;
}

// A normal that counts for both directions has no mean.
Point one_sided_normal(const Group& g) { return g.both_sides ? Point{} : g.normal; }

Group united(const std::vector<Group>& parts) {
  Group whole;
  for (const Group& part : parts) {
    whole.power += part.power;
    add(part.power, part.middle, whole.middle);
    add(part.power, one_sided_normal(part), whole.normal);
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    whole.middle[axis] /= whole.power;
    whole.normal[axis] /= whole.power;
  }
  whole.cos_emission = 1.0;
  for (const Group& part : parts) {
    const double apart = distance(whole.middle, part.middle);
    whole.variance += part.power / whole.power * (part.variance + apart * apart);
    whole.radius = std::max(whole.radius, apart + part.radius);
    // Only lights that all face the same way have a common horizon.
    const bool parallel = distance(whole.normal, part.normal) < 1e-4 && !part.both_sides;
    whole.cos_emission = std::min(whole.cos_emission, parallel ? part.cos_emission : -1.0);
  }
  return whole;
}

// Sums over some lights from which their variance follows; positions are relative to a common origin near by.
struct Sums {
  double power = 0.0;
  Point position{};
  Point normal{};
  double square = 0.0;

  void add(const Group& g, const Point& origin) {
    const Point p = difference(g.middle, origin);
    power += g.power;
    accuray::add(g.power, p, position);
    accuray::add(g.power, one_sided_normal(g), normal);
    square += g.power * (g.variance + dot(p, p));
  }
  void add(const Sums& other) {
    power += other.power;
    accuray::add(1.0, other.position, position);
    accuray::add(1.0, other.normal, normal);
    square += other.square;
  }
  // Power times variance, of the positions and to a lesser degree of the normals: what a choice among them misjudges.
  double cost() const {
    if (power == 0.0) return 0.0;
    const double spread = std::max(square - dot(position, position) / power, 0.0);
    const double scatter = std::max(1.0 - dot(normal, normal) / (power * power), 0.0);
    return spread * (1.0 + scatter);
  }
};

struct Range {
  size_t begin, end;
  double cost;

  size_t count() const { return end - begin; }
  double urgency() const { return count() == 1 ? -1.0 : cost; }
};

struct Split {
  size_t axis = 0;
  size_t bin = 0;  // the first one of the second half
  double cost = -1.0;
  std::array<double, 2> costs{};

  bool found() const { return cost >= 0.0; }
};

// The middles of a range, along each axis in kBins equal parts.
struct Grid {
  Point low, extent;

  size_t bin(const Point& p, size_t axis) const {
    const double share = (p[axis] - low[axis]) / extent[axis];
    return std::min(static_cast<size_t>(share * static_cast<double>(kBins)), kBins - 1);
  }
};

uint32_t axis_word(const Point& normal) {
  uint32_t word = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    const double share = (std::clamp(normal[axis], -1.0, 1.0) + 1.0) / static_cast<double>(tree::coordinate_step);
    word |= static_cast<uint32_t>(std::lround(share)) << (tree::coordinate_bits * axis);
  }
  return word;
}

// Rounded so that the bounds stay bounds.
uint32_t bound_word(double radius, double cos_emission) {
  const uint32_t bits = bits_of(static_cast<float>(std::min(radius, 1e37)));
  const double steps = (std::clamp(cos_emission, -1.0, 1.0) + 1.0) / static_cast<double>(tree::emission_step);
  const uint32_t emission = std::min(static_cast<uint32_t>(steps), tree::emission_mask);
  return ((bits + ~tree::radius_mask) & tree::radius_mask) | emission;
}

class TreeBuilder {
 public:
  TreeBuilder(std::vector<Group> lights, std::vector<uint32_t>& trails) : lights_(std::move(lights)), trails_(trails) {}

  // `unit`: factor of all powers.
  std::vector<LightNode> build(double unit) {
    unit_ = unit;
    if (!lights_.empty()) build_node({0, lights_.size(), 0.0}, 0, 0);
    return std::move(nodes_);
  }

 private:
  // Most lights below a node at this level.
  static uint64_t room(uint32_t level) { return uint64_t{1} << (2 * (tree::most_levels - level)); }

  Group build_node(Range range, uint32_t level, uint32_t trail) {
    const size_t index = nodes_.size();
    nodes_.emplace_back();
    std::vector<Group> parts;
    for (const Range& part : parts_of(range, level)) {
      const uint32_t way = trail | static_cast<uint32_t>(parts.size()) << (2 * level);
      if (part.count() > 1) {
        parts.push_back(build_node(part, level + 1, way));
      } else {
        parts.push_back(lights_[part.begin]);
        trails_[parts.back().child & ~tree::is_light] = way;
      }
    }
    for (size_t lane = 0; lane < parts.size(); ++lane) write(parts[lane], lane, nodes_[index]);
    Group whole = united(parts);
    whole.child = static_cast<uint32_t>(index);
    return whole;
  }

  // A single light alone, or two to four parts of a range, in order.
  std::vector<Range> parts_of(Range range, uint32_t level) {
    std::vector<Range> parts{range};
    while (parts.size() < kWidth) {
      const auto most = std::max_element(parts.begin(), parts.end(),
                                         [](const Range& a, const Range& b) { return a.urgency() < b.urgency(); });
      if (most->count() == 1) break;
      const auto [first, second] = halves(*most);
      *most = first;
      parts.insert(most + 1, second);
    }
    const bool fits = std::all_of(parts.begin(), parts.end(), [&](const Range& part) {
      return part.count() == 1 || part.count() <= room(level + 1);
    });
    return fits ? parts : equal_parts(range);
  }

  // By number alone: where splits of unequal halves would make the tree too deep.
  static std::vector<Range> equal_parts(Range range) {
    std::vector<Range> parts;
    parts.reserve(kWidth);
    for (size_t k = 0; k < kWidth; ++k) {
      parts.push_back({range.begin + range.count() * k / kWidth, range.begin + range.count() * (k + 1) / kWidth, 0.0});
    }
    return parts;
  }

  std::pair<Range, Range> halves(Range range) {
    const Grid grid = grid_of(range);
    Split best;
    for (size_t axis = 0; axis < 3; ++axis) {
      if (grid.extent[axis] > 0.0) consider(range, grid, axis, best);
    }
    const size_t half = range.begin + range.count() / 2;
    if (!best.found()) return {{range.begin, half, 0.0}, {half, range.end, 0.0}};
    const auto begin = lights_.begin();
    const auto middle =
        std::stable_partition(begin + static_cast<ptrdiff_t>(range.begin), begin + static_cast<ptrdiff_t>(range.end),
                              [&](const Group& g) { return grid.bin(g.middle, best.axis) < best.bin; });
    const auto at = static_cast<size_t>(middle - begin);
    return {{range.begin, at, best.costs[0]}, {at, range.end, best.costs[1]}};
  }

  Grid grid_of(Range range) const {
    Grid grid{lights_[range.begin].middle, lights_[range.begin].middle};
    for (size_t i = range.begin; i < range.end; ++i) {
      for (size_t axis = 0; axis < 3; ++axis) {
        grid.low[axis] = std::min(grid.low[axis], lights_[i].middle[axis]);
        grid.extent[axis] = std::max(grid.extent[axis], lights_[i].middle[axis]);
      }
    }
    for (size_t axis = 0; axis < 3; ++axis) grid.extent[axis] -= grid.low[axis];
    return grid;
  }

  // The best split along an axis, if it is better than the best so far.
  void consider(Range range, const Grid& grid, size_t axis, Split& best) const {
    std::array<Sums, kBins> bins;
    for (size_t i = range.begin; i < range.end; ++i) {
      bins[grid.bin(lights_[i].middle, axis)].add(lights_[i], grid.low);
    }
    std::array<double, kBins> second{};
    Sums sum;
    for (size_t b = kBins - 1; b > 0; --b) {
      sum.add(bins[b]);
      second[b] = sum.cost();
    }
    sum = {};
    for (size_t b = 1; b < kBins; ++b) {
      sum.add(bins[b - 1]);
      if (bins[b].power == 0.0) continue;
      const double first = sum.cost();
      if (!best.found() || first + second[b] < best.cost) best = {axis, b, first + second[b], {first, second[b]}};
    }
  }

  void write(const Group& g, size_t lane, LightNode& node) const {
    constexpr double kRounding = 1e-6;
    const double size = std::max({std::fabs(g.middle[0]), std::fabs(g.middle[1]), std::fabs(g.middle[2])});
    node.x[lane] = static_cast<float>(g.middle[0]);
    node.y[lane] = static_cast<float>(g.middle[1]);
    node.z[lane] = static_cast<float>(g.middle[2]);
    node.variance[lane] = static_cast<float>(g.variance);
    node.intensity[lane] = std::max(static_cast<float>(g.power * g.gain * unit_), tree::least_weight);
    node.axis[lane] = axis_word(g.normal) | (g.both_sides ? 1u << tree::both_sides_bit : 0u);
    node.bound[lane] = bound_word(g.radius + kRounding * (size + g.radius), g.cos_emission);
    node.child[lane] = g.child;
  }

  std::vector<Group> lights_;
  std::vector<uint32_t>& trails_;
  std::vector<LightNode> nodes_;
  double unit_ = 1.0;
};

}  // namespace

LightTree build_light_tree(const std::vector<Emitter>& emitters, const std::vector<DistantEmitter>& distant,
                           size_t lights) {
  LightTree result;
  result.trails.assign(lights, none);
  std::vector<Group> groups;
  groups.reserve(emitters.size());
  double power = 0.0;
  for (const Emitter& emitter : emitters) {
    groups.push_back(single(emitter));
    power += emitter.power;
  }
  // Intensity of a flat light: its flux over pi.
  const double unit = power > 0.0 ? 1.0 / power : 1.0;
  result.nodes = TreeBuilder(std::move(groups), result.trails).build(unit);
  for (const DistantEmitter& far : distant) {
    result.trails[far.light] = tree::beside | static_cast<uint32_t>(result.distant.size());
    const double irradiance = std::clamp(far.irradiance * static_cast<double>(pi) * unit, 1e-30, 1e30);
    result.distant.push_back({far.light, static_cast<float>(irradiance)});
  }
  return result;
}

}  // namespace accuray
