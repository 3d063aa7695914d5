#include "mesh/splitting.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/index_table.h"
#include "mesh/topology.h"
#include "mesh/weld.h"

namespace accuray::mesh {
namespace {

using Vec3 = std::array<double, 3>;

Vec3 mixed(const Vec3& a, const Vec3& b, double t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}
double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double distance(const Vec3& a, const Vec3& b) {
  Vec3 d = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return std::sqrt(dot(d, d));
}

// Lengths of edges between points in the camera's axes.
class Ruler {
 public:
  explicit Ruler(const View& view) : view_(view) {}

  Vec3 in_camera(const float* p) const {
    Vec3 q;
    for (size_t i = 0; i < 3; ++i) {
      const double* row = &view_.to_camera[4 * i];
      q[i] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
    }
    return q;
  }

  double length(Vec3 a, Vec3 b, Measure measure) const {
    if (b < a) std::swap(a, b);
    return measure == Measure::facing ? facing(a, b) : std::max(seen(a, b), facing(a, b) / kUnseen);
  }

 private:
  // As if the edge faced the camera at its nearest point.
  double facing(const Vec3& a, const Vec3& b) const {
    double size = distance(a, b);
    if (view_.projection == View::Projection::orthographic) return view_.scale * size;
    if (!(size > 0.0)) return 0.0;
    Vec3 d = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    double t = std::clamp(-dot(a, d) / (size * size), 0.0, 1.0);
    double nearest = distance(mixed(a, b, t), {});
    // An edge through the eye is as long as the picture can show.
    return view_.scale * std::min(size / std::max(nearest, 1e-9 * size), 1e3);
  }

  double seen(Vec3 a, Vec3 b) const {
    if (view_.projection == View::Projection::angular) {
      // The chord, which is the angle where it is that of a pixel.
      double size_a = distance(a, {}), size_b = distance(b, {});
      if (!(size_a > 0.0) || !(size_b > 0.0)) return 0.0;
      return view_.scale * distance(mixed({}, a, 1.0 / size_a), mixed({}, b, 1.0 / size_b));
    }
    return clip(a, b) ? projected(a, b) : 0.0;
  }

  // Cuts off what is out of the picture; false if nothing is left. Its sides are planes through the eye, or parallel.
  bool clip(Vec3& a, Vec3& b) const {
    bool perspective = view_.projection == View::Projection::perspective;
    for (size_t side = 0; side < 4; ++side) {
      double sign = side % 2 == 0 ? 1.0 : -1.0, bound = view_.window[side];
      auto inside = [&](const Vec3& p) { return sign * (p[side / 2] - bound * (perspective ? -p[2] : 1.0)); };
      if (!cut(a, b, inside(a), inside(b))) return false;
    }
    return cut(a, b, -a[2], -b[2]);
  }

  static bool cut(Vec3& a, Vec3& b, double inside_a, double inside_b) {
    if (!(inside_a > 0.0) && !(inside_b > 0.0)) return false;
    if (inside_a < 0.0) a = mixed(a, b, inside_a / (inside_a - inside_b));
    if (inside_b < 0.0) b = mixed(b, a, inside_b / (inside_b - inside_a));
    return true;
  }

  static double hypotenuse(double x, double y) { return std::sqrt(x * x + y * y); }
  double projected(const Vec3& a, const Vec3& b) const {
    if (view_.projection == View::Projection::orthographic) return view_.scale * hypotenuse(a[0] - b[0], a[1] - b[1]);
    double za = std::max(-a[2], 1e-300), zb = std::max(-b[2], 1e-300);
    double size = hypotenuse(a[0] / za - b[0] / zb, a[1] / za - b[1] / zb);
    // The eye itself has no place in the picture.
    return std::isfinite(size) ? view_.scale * size : 0.0;
  }

  const View& view_;
};

// Makes the middles of edges, each once for the vertices at its ends.
class Halver {
 public:
  explicit Halver(const MeshData& mesh) : result_(mesh) { result_.indices.clear(); }

  uint32_t middle(uint32_t a, uint32_t b) {
    if (b < a) std::swap(a, b);
    auto hash = [&](uint32_t n) { return hash_words(ends_[n].first, ends_[n].second, 0); };
    std::pair<uint32_t, uint32_t> ends = {a, b};
    uint32_t fresh = static_cast<uint32_t>(ends_.size());
    uint32_t number =
        table_.find_or_insert(hash_words(a, b, 0), fresh, [&](uint32_t n) { return ends_[n] == ends; }, hash);
    if (number == fresh) {
      ends_.push_back(ends);
      halve(result_.positions, 3, a, b);
      halve(result_.uvs, 2, a, b);
      halve(result_.colors, 4, a, b);
      halve(result_.normals, 3, a, b);
      if (!result_.normals.empty()) scale_normal(a);
    }
    return original() + number;
  }

  void add(uint32_t a, uint32_t b, uint32_t c) { result_.indices.insert(result_.indices.end(), {a, b, c}); }
  double squared_distance(uint32_t a, uint32_t b) const {
    double sum = 0.0;
    for (size_t i = 0; i < 3; ++i) {
      double d = double{result_.positions[3 * size_t{a} + i]} - double{result_.positions[3 * size_t{b} + i]};
      sum += d * d;
    }
    return sum;
  }
  MeshData result() { return std::move(result_); }

 private:
  uint32_t original() const { return static_cast<uint32_t>(result_.positions.size() / 3 - ends_.size()); }

  // The mean has the same bits whichever end comes first.
  static void halve(std::vector<float>& values, size_t width, uint32_t a, uint32_t b) {
    if (values.empty()) return;
    for (size_t i = 0; i < width; ++i) {
      values.push_back(static_cast<float>(0.5 * (double{values[width * a + i]} + double{values[width * b + i]})));
    }
  }

  // Where the normals of the ends cancel, the first one holds.
  void scale_normal(uint32_t a) {
    float* n = &result_.normals[result_.normals.size() - 3];
    double size = std::sqrt(double{n[0]} * n[0] + double{n[1]} * n[1] + double{n[2]} * n[2]);
    for (size_t i = 0; i < 3; ++i) {
      n[i] = size > 1e-6 ? static_cast<float>(n[i] / size) : result_.normals[3 * size_t{a} + i];
    }
  }

  MeshData result_;
  std::vector<std::pair<uint32_t, uint32_t>> ends_;  // of the edge of each new vertex
  IndexTable table_;
};

// One triangle, turned so that its first edge is marked and its third one is not, where there are one or two marks.
void split_triangle(Halver& halver, std::array<uint32_t, 3> v, std::array<bool, 3> marked) {
  int marks = marked[0] + marked[1] + marked[2];
  if (marks == 0) return halver.add(v[0], v[1], v[2]);
  while (marks < 3 && !(marked[0] && !marked[2])) {
    std::rotate(v.begin(), v.begin() + 1, v.end());
    std::rotate(marked.begin(), marked.begin() + 1, marked.end());
  }
  uint32_t a = halver.middle(v[0], v[1]);
  if (marks == 1) {
    halver.add(v[0], a, v[2]);
    return halver.add(a, v[1], v[2]);
  }
  uint32_t b = halver.middle(v[1], v[2]);
  halver.add(a, v[1], b);
  if (marks == 3) {
    uint32_t c = halver.middle(v[2], v[0]);
    halver.add(v[0], a, c);
    halver.add(c, b, v[2]);
    return halver.add(a, b, c);
  }
  // Of the quadrilateral that is left, the shorter diagonal.
  if (halver.squared_distance(a, v[2]) <= halver.squared_distance(v[0], b)) {
    halver.add(v[0], a, v[2]);
    halver.add(a, b, v[2]);
  } else {
    halver.add(v[0], a, b);
    halver.add(v[0], b, v[2]);
  }
}

}  // namespace

std::vector<float> lengths_in_view(std::span<const float> positions, std::span<const uint32_t> indices,
                                   const View& view, Measure measure) {
  Ruler ruler(view);
  std::vector<float> lengths(indices.size());
  for (size_t corner = 0; corner < indices.size(); corner += 3) {
    std::array<Vec3, 3> p;
    for (size_t i = 0; i < 3; ++i) p[i] = ruler.in_camera(&positions[3 * size_t{indices[corner + i]}]);
    for (size_t i = 0; i < 3; ++i)
      lengths[corner + i] = static_cast<float>(ruler.length(p[i], p[(i + 1) % 3], measure));
  }
  return lengths;
}

std::vector<uint8_t> spread_marks(std::span<const float> positions, std::span<const uint32_t> indices,
                                  std::span<const uint8_t> marks) {
  Net net;
  std::vector<uint32_t> first = weld(positions);
  for (uint32_t v : indices) net.vertex.push_back(first[v]);
  Faces faces;
  faces.count = static_cast<uint32_t>(indices.size() / 3);
  faces.sides = 3;
  faces.sharpness.resize(indices.size());
  Edges edges(net, faces);
  auto squared_length = [&](size_t c) {
    double sum = 0.0;
    for (size_t i = 0; i < 3; ++i) {
      size_t a = 3 * size_t{net.vertex[c]} + i, b = 3 * size_t{net.vertex[faces.next(static_cast<uint32_t>(c))]} + i;
      sum += (double{positions[a]} - positions[b]) * (double{positions[a]} - positions[b]);
    }
    return sum;
  };
  std::vector<uint8_t> marked(edges.count());
  for (size_t c = 0; c < marks.size(); ++c) marked[edges.of_corner[c]] |= marks[c];
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t c = 0; c < indices.size(); c += 3) {
      const uint32_t* e = &edges.of_corner[c];
      if (marked[e[0]] == 0 && marked[e[1]] == 0 && marked[e[2]] == 0) continue;
      size_t longest = 0;
      for (size_t i = 1; i < 3; ++i) longest = squared_length(c + i) > squared_length(c + longest) ? i : longest;
      changed = changed || marked[e[longest]] == 0;
      marked[e[longest]] = 1;
    }
  }
  std::vector<uint8_t> result(indices.size());
  for (size_t c = 0; c < indices.size(); ++c) result[c] = marked[edges.of_corner[c]];
  return result;
}

MeshData split_edges(const MeshData& mesh, std::span<const uint8_t> marks) {
  Halver halver(mesh);
  for (size_t corner = 0; corner < mesh.indices.size(); corner += 3) {
    const uint32_t* v = &mesh.indices[corner];
    split_triangle(halver, {v[0], v[1], v[2]}, {marks[corner] != 0, marks[corner + 1] != 0, marks[corner + 2] != 0});
  }
  return halver.result();
}

}  // namespace accuray::mesh
