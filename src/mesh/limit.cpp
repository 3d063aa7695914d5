// Limits of subdivision: positions and tangents by eigenvectors of the rules around a vertex. Catmull-Clark: Halstead,
// Kass and DeRose 1993; Loop: Hoppe et al. 1994; across creases and open edges: Biermann, Levin and Zorin 2000.
#include <array>
#include <cmath>

#include "mesh/around.h"
#include "mesh/index_table.h"
#include "mesh/refinement.h"

namespace accuray::mesh {
namespace {

using Vec3 = std::array<double, 3>;

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Vec3& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

// The corners at one vertex between two sharp edges, or all around it, counter-clockwise.
struct Sector {
  std::vector<uint32_t> corners;
  bool closed = false;     // no edge around it is sharp
  uint32_t first_end = 0;  // the vertex at the end of the first edge
  uint32_t last_end = 0;   // and of the last one
};

void find_sector(const Net& net, const Faces& faces, const Edges& edges, uint32_t start, Sector& sector) {
  sector.corners.clear();
  uint32_t first = start;
  sector.closed = false;
  while (edges.sharpness(faces, first) <= 0.0f) {
    first = faces.next(edges.twin[first]);
    if (first != start) continue;
    sector.closed = true;
    break;
  }
  uint32_t c = first;
  for (;;) {
    sector.corners.push_back(c);
    uint32_t edge = faces.previous(c);
    sector.last_end = net.vertex[edge];
    if (edges.sharpness(faces, edge) > 0.0f) break;
    c = edges.twin[edge];
    if (c == first) break;
  }
  sector.first_end = net.vertex[faces.next(first)];
}

// A vertex where one crease ends: no closed form, for every valence has its own eigenvectors. The rules are applied
// around it until it rests.
class Dart {
 public:
  Dart(const Net& net, const Faces& faces, Scheme scheme, uint32_t v, const Sector& sector)
      : scheme_(scheme), width_(net.width), size_(static_cast<uint32_t>(sector.corners.size())) {
    centre_.assign(net.at(v), net.at(v) + width_);
    for (uint32_t c : sector.corners) {
      const double* end = net.at(net.vertex[faces.next(c)]);
      ends_.insert(ends_.end(), end, end + width_);
      const double* far = net.at(net.vertex[faces.next(faces.next(c))]);
      if (scheme == Scheme::catmull_clark) far_.insert(far_.end(), far, far + width_);
    }
  }

  std::vector<double> limit() {
    for (int i = 0; i < kLimitSteps; ++i) step();
    return centre_;
  }

  // Of positions; not of unit length.
  Vec3 normal() {
    for (int i = 0; i < kNormalSteps; ++i) step();
    Vec3 sum{};
    for (uint32_t i = 0; i < size_; ++i) {
      Vec3 n = cross(from_centre(end(i)), from_centre(end(i + 1)));
      add(sum.data(), 1.0, n.data(), 3);
    }
    return sum;
  }

 private:
  // Ample for valences of some hundreds: the slowest mode shrinks by less than a half at a third of them.
  static constexpr int kLimitSteps = 160;
  // The ring is flat long before it is too small for its own rounding.
  static constexpr int kNormalSteps = 24;

  const double* end(uint32_t i) const { return &ends_[width_ * (i % size_)]; }
  Vec3 from_centre(const double* p) const { return {p[0] - centre_[0], p[1] - centre_[1], p[2] - centre_[2]}; }

  void step() {
    std::vector<double> middles(far_.size()), next_ends(ends_.size()), sum_ends(width_), sum_middles(width_);
    for (uint32_t i = 0; i < middles.size() / width_; ++i) {
      double* middle = &middles[width_ * i];
      for (const double* p : std::array<const double*, 4>{centre_.data(), end(i), end(i + 1), &far_[width_ * i]}) {
        add(middle, 0.25, p, width_);
      }
      add(sum_middles.data(), 1.0, middle, width_);
    }
    for (uint32_t i = 0; i < size_; ++i) {
      add(sum_ends.data(), 1.0, end(i), width_);
      double* target = &next_ends[width_ * i];
      bool loop = scheme_ == Scheme::loop;
      double near = i == 0 ? 0.5 : (loop ? 3.0 / 8.0 : 0.25);
      add(target, near, centre_.data(), width_);
      add(target, near, end(i), width_);
      if (i == 0) continue;
      add(target, loop ? 0.125 : 0.25, loop ? end(i - 1) : &middles[width_ * (i - 1)], width_);
      add(target, loop ? 0.125 : 0.25, loop ? end(i + 1) : &middles[width_ * i], width_);
    }
    std::vector<double> centre(width_);
    SmoothRule smooth{width_, scheme_, size_, size_};
    smooth.add_to(centre.data(), 1.0, centre_.data(), sum_ends.data(), sum_middles.data());
    centre_ = std::move(centre);
    ends_ = std::move(next_ends);
    far_ = std::move(middles);
  }

  Scheme scheme_;
  size_t width_;
  uint32_t size_;
  std::vector<double> centre_, ends_, far_;
};

void add_smooth_limit(const Net& net, Scheme scheme, uint32_t v, uint32_t valence, const double* ends,
                      const double* far, double* target) {
  double n = valence;
  if (scheme == Scheme::loop) {
    double w = 1.0 / (3.0 / (8.0 * loop_weight(valence)) + n);
    add(target, 1.0 - n * w, net.at(v), net.width);
    add(target, w, ends, net.width);
    return;
  }
  double w = 1.0 / (n * (n + 5.0));
  add(target, n * n * w, net.at(v), net.width);
  add(target, 4.0 * w, ends, net.width);
  add(target, w, far, net.width);
}

// Sums of the vertices across the quadrilaterals around each vertex.
std::vector<double> far_sums(const Net& net, const Faces& faces) {
  std::vector<double> sums(net.points.size());
  for (uint32_t c = 0; c < faces.corners(); ++c) {
    add(&sums[net.width * net.vertex[c]], 1.0, net.at(net.vertex[faces.next(faces.next(c))]), net.width);
  }
  return sums;
}

// Two tangents of a closed ring.
void add_ring_tangents(const Net& net, const Faces& faces, const Sector& sector, Scheme scheme, Vec3& s, Vec3& t) {
  uint64_t n = sector.corners.size();
  Turn one = turn(1, n), half = turn(1, 2 * n);
  double near = scheme == Scheme::loop ? 1.0 : 1.0 + one.cos + half.cos * std::sqrt(2.0 * (9.0 + one.cos));
  for (uint64_t i = 0; i < n; ++i) {
    uint32_t c = sector.corners[i];
    Turn a = turn(i, n), b = turn(i + 1, n);
    add(s.data(), near * a.cos, net.at(net.vertex[faces.next(c)]), 3);
    add(t.data(), near * a.sin, net.at(net.vertex[faces.next(c)]), 3);
    if (scheme == Scheme::loop) continue;
    add(s.data(), a.cos + b.cos, net.at(net.vertex[faces.next(faces.next(c))]), 3);
    add(t.data(), a.sin + b.sin, net.at(net.vertex[faces.next(faces.next(c))]), 3);
  }
}

// Across a crease, into a sector of k polygons. That of Loop's scheme is the left eigenvector of its rules with the
// eigenvalue 3/8 + cos(pi / k) / 4; Hoppe et al. 1994 have another one, for their own rules at creases.
Vec3 tangent_across(const Net& net, const Faces& faces, const Sector& sector, Scheme scheme, uint32_t v) {
  uint64_t k = sector.corners.size();
  bool loop = scheme == Scheme::loop;
  Turn one = turn(1, 2 * k);
  double r = k == 1 ? 1.0 : (one.cos + 1.0) / one.sin;
  double ends = loop ? -r * one.cos / (1.0 + 2.0 * one.cos) : -r * (1.0 + 2.0 * one.cos);
  double centre = loop ? -r / (1.0 + 2.0 * one.cos) : 4.0 * r * (one.cos - 1.0);
  if (k == 1) ends = 1.0, centre = -2.0;
  Vec3 t{};
  auto add_to = [&](double weight, uint32_t vertex) { add(t.data(), weight, net.at(vertex), 3); };
  add_to(ends, sector.first_end);
  add_to(ends, sector.last_end);
  add_to(centre, v);
  for (uint64_t i = 0; i < k && k > 1; ++i) {
    uint32_t c = sector.corners[i];
    double here = turn(i, 2 * k).sin, next = turn(i + 1, 2 * k).sin;
    if (i + 1 < k) add_to(loop ? next : 4.0 * next, net.vertex[faces.previous(c)]);
    if (!loop) add_to(here + next, net.vertex[faces.next(faces.next(c))]);
  }
  return t;
}

// The normal of the polygons between the limits, where tangents have no closed form.
Vec3 facet_normal(const Net& net, const Faces& faces, const Sector& sector, uint32_t v,
                  const std::vector<double>& limits) {
  Vec3 sum{};
  auto from_v = [&](uint32_t end) {
    Vec3 d{};
    for (size_t i = 0; i < 3; ++i) d[i] = limits[3 * size_t{end} + i] - limits[3 * size_t{v} + i];
    return d;
  };
  for (uint32_t c : sector.corners) {
    Vec3 n = cross(from_v(net.vertex[faces.next(c)]), from_v(net.vertex[faces.previous(c)]));
    add(sum.data(), 1.0, n.data(), 3);
  }
  return sum;
}

Vec3 sector_normal(const Net& net, const Faces& faces, const Sector& sector, Scheme scheme, uint32_t v, Rule rule,
                   const std::vector<double>& limits) {
  Vec3 s{}, t{};
  if (rule == Rule::smooth && sector.closed) {
    add_ring_tangents(net, faces, sector, scheme, s, t);
  } else if (rule == Rule::crease) {
    add(s.data(), 1.0, net.at(sector.first_end), 3);
    add(s.data(), -1.0, net.at(sector.last_end), 3);
    t = tangent_across(net, faces, sector, scheme, v);
  } else if (rule == Rule::corner && sector.corners.size() == 1) {
    for (auto [tangent, end] : {std::pair{&s, sector.first_end}, {&t, sector.last_end}}) {
      add(tangent->data(), 1.0, net.at(end), 3);
      add(tangent->data(), -1.0, net.at(v), 3);
    }
  }
  Vec3 n = cross(s, t);
  double size = length(n);
  if (rule == Rule::smooth && !sector.closed) {
    n = Dart(net, faces, scheme, v, sector).normal();
    size = length(n);
  } else if (!(size > 1e-9 * length(s) * length(t)) || !std::isfinite(size)) {
    n = facet_normal(net, faces, sector, v, limits);
    size = length(n);
  }
  if (!(size > 0.0) || !std::isfinite(size)) return {0.0, 1.0, 0.0};
  return {n[0] / size, n[1] / size, n[2] / size};
}

}  // namespace

std::vector<double> limit_points(const Net& net, const Faces& faces, const Edges& edges, Scheme scheme) {
  Around around(net, faces, edges);
  std::vector<double> far;
  if (scheme == Scheme::catmull_clark) far = far_sums(net, faces);
  std::vector<double> limits(net.points.size());
  for (uint32_t v = 0; v < net.vertices(); ++v) {
    const Around::Counts& n = around.counts[v];
    double* target = &limits[net.width * v];
    Rule rule = rule_of(n.sharp, net.peak[v]);
    if (n.faces == 0 || rule == Rule::corner) {
      add(target, 1.0, net.at(v), net.width);
    } else if (rule == Rule::crease) {
      add(target, 4.0 / 6.0, net.at(v), net.width);
      add(target, 1.0 / 6.0, &around.sharp[net.width * v], net.width);
    } else if (n.sharp == 0) {
      add_smooth_limit(net, scheme, v, n.edges, &around.ends[net.width * v],
                       far.empty() ? nullptr : &far[net.width * v], target);
    }
  }
  Sector sector;
  for (uint32_t c = 0; c < faces.corners(); ++c) {
    uint32_t v = net.vertex[c];
    if (around.counts[v].sharp != 1 || net.peak[v] > 0.0f || edges.sharpness(faces, c) <= 0.0f) continue;
    find_sector(net, faces, edges, c, sector);
    std::vector<double> limit = Dart(net, faces, scheme, v, sector).limit();
    std::copy(limit.begin(), limit.end(), &limits[net.width * v]);
  }
  return limits;
}

LimitNormals limit_normals(const Net& net, const Faces& faces, const Edges& edges, Scheme scheme,
                           const std::vector<double>& limits) {
  Around around(net, faces, edges);
  LimitNormals result;
  result.of_corner.assign(faces.corners(), kNone);
  Sector sector;
  for (uint32_t c = 0; c < faces.corners(); ++c) {
    if (result.of_corner[c] != kNone) continue;
    find_sector(net, faces, edges, c, sector);
    uint32_t v = net.vertex[c];
    Rule rule = rule_of(around.counts[v].sharp, net.peak[v]);
    Vec3 n = sector_normal(net, faces, sector, scheme, v, rule, limits);
    for (uint32_t corner : sector.corners) result.of_corner[corner] = static_cast<uint32_t>(result.normals.size() / 3);
    result.normals.insert(result.normals.end(), n.begin(), n.end());
  }
  return result;
}

}  // namespace accuray::mesh
