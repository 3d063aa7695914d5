#include "mesh/normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "mesh/weld.h"

namespace accuray::mesh {
namespace {

using Vec3 = std::array<double, 3>;

Vec3 operator-(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 operator+(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Vec3& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }
Vec3 unit(const Vec3& a) {
  double scale = 1.0 / length(a);
  return {a[0] * scale, a[1] * scale, a[2] * scale};
}

// Arc tangent of x in [0, 1], to 2e-8 (Abramowitz and Stegun 1964, 4.4.49): ample for a weight.
double arc_tangent(double x) {
  double y = x * x;
  return x * (1.0 +
              y * (-0.3333314528 +
                   y * (0.1999355085 +
                        y * (-0.1420889944 +
                             y * (0.1065626393 + y * (-0.0752896400 +
                                                      y * (0.0429096138 + y * (-0.0161657367 + y * 0.0028662257))))))));
}

// Angle between unit vectors, accurate for small and flat angles too (Kahan 2006): 2 atan(|a - b| / |a + b|).
double angle(const Vec3& a, const Vec3& b) {
  double opposite = length(a - b), adjacent = length(a + b);
  if (opposite <= adjacent) return 2.0 * arc_tangent(opposite / adjacent);
  return std::numbers::pi - 2.0 * arc_tangent(adjacent / opposite);
}

// Weighted sum of face normals, with the sum of the weights.
struct Sum {
  Vec3 normal{};
  double weight = 0.0;

  void add(const Vec3& n, double w) {
    for (size_t i = 0; i < 3; ++i) normal[i] += w * n[i];
    weight += w;
  }
  void add(const Sum& other) {
    for (size_t i = 0; i < 3; ++i) normal[i] += other.normal[i];
    weight += other.weight;
  }
  // Whether the normals do not cancel.
  bool points_somewhere() const { return length(normal) > 1e-6 * weight; }
};

struct Triangle {
  std::array<uint32_t, 3> vertex;
  Vec3 normal;
  std::array<double, 3> angle;
};

Triangle triangle_at(std::span<const float> positions, std::span<const uint32_t> indices, size_t corner) {
  Triangle t;
  std::array<Vec3, 3> p;
  for (size_t i = 0; i < 3; ++i) {
    t.vertex[i] = indices[corner + i];
    const float* v = &positions[3 * size_t{t.vertex[i]}];
    p[i] = {v[0], v[1], v[2]};
  }
  Vec3 u = unit(p[1] - p[0]), v = unit(p[2] - p[1]), w = unit(p[0] - p[2]);
  Vec3 back_u = Vec3{} - u, back_v = Vec3{} - v, back_w = Vec3{} - w;
  t.normal = unit(cross(p[1] - p[0], p[2] - p[1]));
  t.angle = {angle(u, back_w), angle(v, back_u), angle(w, back_v)};
  return t;
}

}  // namespace

std::vector<float> smooth_normals(std::span<const float> positions, std::span<const uint32_t> indices) {
  size_t vertices = positions.size() / 3;
  std::vector<Sum> own(vertices);
  for (size_t corner = 0; corner < indices.size(); corner += 3) {
    Triangle t = triangle_at(positions, indices, corner);
    for (size_t i = 0; i < 3; ++i) own[t.vertex[i]].add(t.normal, t.angle[i]);
  }

  std::vector<uint32_t> first = weld(positions);
  std::vector<Sum> shared = own;
  for (size_t i = 0; i < vertices; ++i) {
    if (first[i] == i) continue;
    shared[first[i]].add(own[i]);
  }

  std::vector<float> normals(positions.size());
  std::vector<bool> cancelled(vertices);
  for (size_t i = 0; i < vertices; ++i) {
    const Sum& sum = shared[first[i]].points_somewhere() ? shared[first[i]] : own[i];
    cancelled[i] = sum.weight > 0.0 && !sum.points_somewhere();
    Vec3 n = sum.weight > 0.0 && !cancelled[i] ? unit(sum.normal) : Vec3{0.0, 1.0, 0.0};
    for (size_t j = 0; j < 3; ++j) normals[3 * i + j] = static_cast<float>(n[j]);
  }
  for (size_t corner = 0; corner < indices.size(); corner += 3) {
    if (!cancelled[indices[corner]] && !cancelled[indices[corner + 1]] && !cancelled[indices[corner + 2]]) continue;
    Triangle t = triangle_at(positions, indices, corner);
    for (uint32_t vertex : t.vertex) {
      if (!cancelled[vertex]) continue;
      for (size_t j = 0; j < 3; ++j) normals[3 * size_t{vertex} + j] = static_cast<float>(t.normal[j]);
    }
  }
  return normals;
}

namespace {

// The corners at one position, and which of them are one smooth piece of surface.
class Fan {
 public:
  void clear() {
    corners_.clear();
    rays_.clear();
  }
  // `next` and `previous`: the positions of the other corners of the triangle.
  void add(uint32_t corner, uint32_t next, uint32_t previous) {
    uint32_t number = static_cast<uint32_t>(corners_.size());
    corners_.push_back({corner, number});
    rays_.push_back({next, number});
    rays_.push_back({previous, number});
  }
  // Joins the corners on both sides of each edge for which smooth(corner, corner) holds.
  template <class Smooth>
  void join(Smooth smooth) {
    std::sort(rays_.begin(), rays_.end());
    for (size_t i = 1; i < rays_.size(); ++i) {
      if (rays_[i].first != rays_[i - 1].first) continue;
      uint32_t a = rays_[i - 1].second, b = rays_[i].second;
      if (smooth(corners_[a].corner, corners_[b].corner)) unite(a, b);
    }
  }
  size_t size() const { return corners_.size(); }
  uint32_t corner(size_t i) const { return corners_[i].corner; }
  // The number of one corner of the piece that corner i belongs to.
  uint32_t piece(size_t i) {
    uint32_t root = static_cast<uint32_t>(i);
    while (corners_[root].parent != root) root = corners_[root].parent = corners_[corners_[root].parent].parent;
    return root;
  }

 private:
  struct Member {
    uint32_t corner, parent;
  };
  void unite(uint32_t a, uint32_t b) {
    uint32_t x = piece(a), y = piece(b);
    corners_[std::max(x, y)].parent = std::min(x, y);
  }
  std::vector<Member> corners_;
  std::vector<std::pair<uint32_t, uint32_t>>
      rays_;  // the position at the other end of an edge, and the corner's number
};

// Corners in the order of the positions that they are at: those of position p are [start[p], start[p + 1]).
struct CornersByPosition {
  std::vector<uint32_t> start, corners;

  CornersByPosition(std::span<const uint32_t> indices, const std::vector<uint32_t>& first)
      : start(first.size() + 1), corners(indices.size()) {
    for (uint32_t vertex : indices) ++start[first[vertex] + 1];
    for (size_t p = 0; p < first.size(); ++p) start[p + 1] += start[p];
    std::vector<uint32_t> next(start.begin(), start.end() - 1);
    for (uint32_t c = 0; c < indices.size(); ++c) corners[next[first[indices[c]]]++] = c;
  }
};

}  // namespace

CreasedMesh creased_normals(std::span<const float> positions, std::span<const uint32_t> indices,
                            std::span<const uint32_t> groups, double least_cosine) {
  std::vector<uint32_t> first = weld(positions);
  CornersByPosition around(indices, first);
  auto triangle = [&](uint32_t corner) { return triangle_at(positions, indices, corner - corner % 3); };
  auto smooth = [&](uint32_t a, uint32_t b) {
    if (!groups.empty() && (groups[a / 3] != groups[b / 3] || groups[a / 3] == 0)) return false;
    Vec3 m = triangle(a).normal, n = triangle(b).normal;
    return m[0] * n[0] + m[1] * n[1] + m[2] * n[2] >= least_cosine;
  };
  auto other = [&](uint32_t corner, uint32_t step) {
    return first[indices[corner - corner % 3 + (corner + step) % 3]];
  };

  CreasedMesh result;
  result.indices.resize(indices.size());
  Fan fan;
  std::vector<Sum> sums;
  std::vector<std::array<uint32_t, 3>> order;  // piece, old vertex, number in the fan
  for (size_t p = 0; p < first.size(); ++p) {
    fan.clear();
    for (uint32_t i = around.start[p]; i < around.start[p + 1]; ++i) {
      uint32_t corner = around.corners[i];
      fan.add(corner, other(corner, 1), other(corner, 2));
    }
    fan.join(smooth);
    sums.assign(fan.size(), {});
    order.clear();
    for (uint32_t i = 0; i < fan.size(); ++i) {
      Triangle t = triangle(fan.corner(i));
      sums[fan.piece(i)].add(t.normal, t.angle[fan.corner(i) % 3]);
      order.push_back({fan.piece(i), indices[fan.corner(i)], i});
    }
    std::sort(order.begin(), order.end());
    for (size_t i = 0; i < order.size(); ++i) {
      auto [piece, vertex, number] = order[i];
      if (i == 0 || order[i - 1][0] != piece || order[i - 1][1] != vertex) {
        Vec3 n = sums[piece].points_somewhere() ? unit(sums[piece].normal) : triangle(fan.corner(number)).normal;
        result.source.push_back(vertex);
        for (double x : n) result.normals.push_back(static_cast<float>(x));
      }
      result.indices[fan.corner(number)] = static_cast<uint32_t>(result.source.size() - 1);
    }
  }
  return result;
}

}  // namespace accuray::mesh
