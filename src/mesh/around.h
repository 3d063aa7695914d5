// What lies around the vertices of a net, and which rule of subdivision that asks for.
#pragma once

#include <algorithm>

#include "mesh/refinement.h"
#include "mesh/turn.h"

namespace accuray::mesh {

// What is left of a sharpness after one step.
inline float faded(float sharpness) { return sharpness >= kSharp ? kSharp : std::max(sharpness - 1.0f, 0.0f); }

inline void add(double* target, double weight, const double* value, size_t width) {
  for (size_t i = 0; i < width; ++i) target[i] += weight * value[i];
}

// The rule for a vertex, by the number of sharp edges around it.
enum class Rule { smooth, crease, corner };
inline Rule rule_of(uint32_t sharp_edges, float peak) {
  if (peak > 0.0f || sharp_edges > 2) return Rule::corner;
  return sharp_edges == 2 ? Rule::crease : Rule::smooth;
}

// Sums over what is around each vertex.
struct Around {
  struct Counts {
    uint32_t edges = 0, faces = 0;
    uint32_t sharp = 0, later = 0;  // edges that are sharp in this step and still in the next
    uint32_t fading = 0;            // those that are not any more
    float fade = 0.0f;              // and the sum of what they are in this step
  };
  std::vector<Counts> counts;
  std::vector<double> ends, sharp,
      later;  // sums of the other ends of all edges, of sharp ones, of those in the next step

  Around(const Net& net, const Faces& faces, const Edges& edges)
      : counts(net.vertices()), ends(net.points.size()), sharp(net.points.size()), later(net.points.size()) {
    for (uint32_t c : edges.corner) {
      uint32_t a = net.vertex[c], b = net.vertex[faces.next(c)];
      float s = edges.sharpness(faces, c);
      add_edge(net, a, b, s);
      add_edge(net, b, a, s);
    }
    for (uint32_t v : net.vertex) ++counts[v].faces;
  }

 private:
  void add_edge(const Net& net, uint32_t v, uint32_t end, float sharpness) {
    Counts& n = counts[v];
    ++n.edges;
    add(&ends[net.width * v], 1.0, net.at(end), net.width);
    if (sharpness <= 0.0f) return;
    ++n.sharp;
    add(&sharp[net.width * v], 1.0, net.at(end), net.width);
    if (faded(sharpness) > 0.0f) {
      ++n.later;
      add(&later[net.width * v], 1.0, net.at(end), net.width);
    } else {
      ++n.fading;
      n.fade += sharpness;
    }
  }
};

// Weight of each neighbour in Loop's rule for a vertex with n of them.
inline double loop_weight(uint32_t n) {
  double c = 3.0 / 8.0 + turn(1, n).cos / 4.0;
  return (5.0 / 8.0 - c * c) / n;
}

// The rule for a vertex without creases, as sums over what is around it.
struct SmoothRule {
  size_t width;
  Scheme scheme;
  uint32_t edges, faces;

  // ends: of the edges; middles: of the polygons, for catmull_clark.
  void add_to(double* target, double weight, const double* centre, const double* ends, const double* middles) const {
    double n = edges;
    if (scheme == Scheme::loop) {
      double w = loop_weight(edges);
      add(target, weight * (1.0 - n * w), centre, width);
      add(target, weight * w, ends, width);
      return;
    }
    add(target, weight * (n - 2.0) / n, centre, width);
    add(target, weight / (n * n), ends, width);
    add(target, weight / (n * faces), middles, width);
  }
};

}  // namespace accuray::mesh
