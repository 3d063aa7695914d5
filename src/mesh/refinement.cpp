#include "mesh/refinement.h"

#include <algorithm>

#include "mesh/around.h"

namespace accuray::mesh {
namespace {

// Points of the refined net: those of the vertices, then of the edges, then of the polygons.
class Refiner {
 public:
  Refiner(const Net& net, const Faces& faces, const Edges& edges, Scheme scheme)
      : net_(net), faces_(faces), edges_(edges), scheme_(scheme), width_(net.width) {
    size_t middles = scheme == Scheme::catmull_clark ? faces.count : 0;
    points_.resize(width_ * (size_t{net.vertices()} + edges.count() + middles));
    if (middles > 0) add_middles();
  }

  std::vector<double> smooth() {
    for (uint32_t e = 0; e < edges_.count(); ++e) add_edge(e, edges_.sharpness(faces_, edges_.corner[e]));
    Around around(net_, faces_, edges_);
    std::vector<double> middles;
    if (scheme_ == Scheme::catmull_clark) middles = middles_around();
    for (uint32_t v = 0; v < net_.vertices(); ++v) {
      if (around.counts[v].faces > 0) add_vertex(v, around, middles.empty() ? nullptr : &middles[width_ * v]);
    }
    return std::move(points_);
  }

  std::vector<double> linear() {
    for (uint32_t e = 0; e < edges_.count(); ++e) add_edge(e, kSharp);
    std::copy(net_.points.begin(), net_.points.end(), points_.begin());
    return std::move(points_);
  }

 private:
  double* edge_point(uint32_t e) { return &points_[width_ * (size_t{net_.vertices()} + e)]; }
  double* middle(uint32_t f) { return &points_[width_ * (size_t{net_.vertices()} + edges_.count() + f)]; }

  void add_middles() {
    for (uint32_t f = 0; f < faces_.count; ++f) {
      double weight = 1.0 / (faces_.end(f) - faces_.begin(f));
      for (uint32_t c = faces_.begin(f); c < faces_.end(f); ++c)
        add(middle(f), weight, net_.at(net_.vertex[c]), width_);
    }
  }

  std::vector<double> middles_around() {
    std::vector<double> sums(net_.points.size());
    for (uint32_t c = 0; c < faces_.corners(); ++c) {
      add(&sums[width_ * net_.vertex[c]], 1.0, middle(faces_.face(c)), width_);
    }
    return sums;
  }

  void add_edge(uint32_t e, float sharpness) {
    uint32_t c = edges_.corner[e], twin = edges_.twin[c];
    double sharp = std::min(sharpness, 1.0f), smooth = 1.0 - sharp;
    double ends = scheme_ == Scheme::loop ? 3.0 / 8.0 : 1.0 / 4.0;
    add(edge_point(e), sharp * 0.5 + smooth * ends, net_.at(net_.vertex[c]), width_);
    add(edge_point(e), sharp * 0.5 + smooth * ends, net_.at(net_.vertex[faces_.next(c)]), width_);
    if (smooth <= 0.0) return;
    for (uint32_t side : {c, twin}) {
      if (scheme_ == Scheme::loop) {
        add(edge_point(e), smooth / 8.0, net_.at(net_.vertex[faces_.previous(side)]), width_);
      } else {
        add(edge_point(e), smooth / 4.0, middle(faces_.face(side)), width_);
      }
    }
  }

  void add_vertex(uint32_t v, const Around& around, const double* middles) {
    const Around::Counts& n = around.counts[v];
    float peak = net_.peak[v];
    Rule now = rule_of(n.sharp, peak), later = rule_of(n.later, faded(peak));
    double share = 1.0;
    if (now != later) {
      bool peak_fades = peak > 0.0f && faded(peak) <= 0.0f;
      float fade = n.fade + (peak_fades ? peak : 0.0f);
      share = std::min(fade / static_cast<float>(n.fading + (peak_fades ? 1u : 0u)), 1.0f);
      add_rule(later, v, around, around.later, middles, 1.0 - share);
    }
    add_rule(now, v, around, around.sharp, middles, share);
  }

  void add_rule(Rule rule, uint32_t v, const Around& around, const std::vector<double>& sharp, const double* middles,
                double weight) {
    double* target = &points_[width_ * v];
    if (rule == Rule::corner) {
      add(target, weight, net_.at(v), width_);
    } else if (rule == Rule::crease) {
      add(target, weight * 0.75, net_.at(v), width_);
      add(target, weight * 0.125, &sharp[width_ * v], width_);
    } else {
      SmoothRule smooth{width_, scheme_, around.counts[v].edges, around.counts[v].faces};
      smooth.add_to(target, weight, net_.at(v), &around.ends[width_ * v], middles);
    }
  }

  const Net& net_;
  const Faces& faces_;
  const Edges& edges_;
  Scheme scheme_;
  size_t width_;
  std::vector<double> points_;
};

}  // namespace

Net refined(const Net& net, const Faces& faces, const Edges& edges, Scheme scheme, Smoothness smoothness) {
  Net result;
  result.width = net.width;
  Refiner refiner(net, faces, edges, scheme);
  result.points = smoothness == Smoothness::smooth ? refiner.smooth() : refiner.linear();
  result.peak.resize(result.points.size() / net.width);
  for (uint32_t v = 0; v < net.vertices(); ++v) result.peak[v] = faded(net.peak[v]);
  uint32_t edge = net.vertices(), middle = edge + edges.count();
  result.vertex.reserve(4 * size_t{faces.corners()});
  for (uint32_t f = 0; f < faces.count; ++f) {
    for (uint32_t c = faces.begin(f); c < faces.end(f); ++c) {
      result.vertex.push_back(net.vertex[c]);
      result.vertex.push_back(edge + edges.of_corner[c]);
      if (scheme == Scheme::catmull_clark) result.vertex.push_back(middle + f);
      result.vertex.push_back(edge + edges.of_corner[faces.previous(c)]);
    }
    if (scheme == Scheme::catmull_clark) continue;
    for (uint32_t c = faces.begin(f); c < faces.end(f); ++c) result.vertex.push_back(edge + edges.of_corner[c]);
  }
  return result;
}

Faces refined(const Faces& faces, Scheme scheme) {
  Faces result;
  result.sides = scheme == Scheme::loop ? 3 : 4;
  for (uint32_t f = 0; f < faces.count; ++f) {
    for (uint32_t c = faces.begin(f); c < faces.end(f); ++c) {
      float after = faded(faces.sharpness[c]), before = faded(faces.sharpness[faces.previous(c)]);
      result.sharpness.push_back(after);
      result.sharpness.insert(result.sharpness.end(), scheme == Scheme::loop ? 1 : 2, 0.0f);
      result.sharpness.push_back(before);
    }
    if (scheme == Scheme::loop) result.sharpness.insert(result.sharpness.end(), 3, 0.0f);
  }
  result.count = result.corners() / result.sides;
  return result;
}

}  // namespace accuray::mesh
