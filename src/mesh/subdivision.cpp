#include "mesh/subdivision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "mesh/index_table.h"
#include "mesh/weld.h"

namespace accuray::mesh {
namespace {

// The polygons of a mesh: their sizes, and the vertices of their corners.
struct Polygons {
  std::vector<uint32_t> sizes, vertices;
};

bool usable(const float* p) {
  return std::all_of(p, p + 3, [](float x) { return std::fabs(x) <= kMaxCoordinate; });
}

// Reads the fans of triangles back as polygons, and drops those that cannot be subdivided.
Polygons polygons_of(const MeshData& control, Scheme scheme, const std::vector<uint32_t>& first, MeshReport& report) {
  Polygons result;
  std::vector<uint32_t> polygon, places;
  size_t triangle = 0, count = control.indices.size() / 3;
  bool cut = scheme == Scheme::loop || control.polygons.empty();
  for (size_t i = 0; triangle < count; ++i) {
    uint32_t size = cut ? 3 : control.polygons[i];
    const uint32_t* fan = &control.indices[3 * triangle];
    polygon.assign(fan, fan + 3);
    for (uint32_t k = 3; k < size; ++k) polygon.push_back(fan[3 * (k - 2) + 2]);
    triangle += size - 2;
    places.clear();
    bool finite = true;
    for (uint32_t v : polygon) {
      places.push_back(first[v]);
      finite = finite && usable(&control.positions[3 * size_t{v}]);
    }
    std::sort(places.begin(), places.end());
    bool twice = std::adjacent_find(places.begin(), places.end()) != places.end();
    if (!finite) {
      report.nonfinite_triangles += size - 2;
    } else if (twice) {
      report.degenerate_triangles += size - 2;
    } else {
      result.sizes.push_back(size);
      result.vertices.insert(result.vertices.end(), polygon.begin(), polygon.end());
    }
  }
  report.triangles_read = count;
  return result;
}

Net position_net(const MeshData& control, const Polygons& polygons, const std::vector<uint32_t>& first) {
  Net net;
  net.width = 3;
  net.points.assign(control.positions.begin(), control.positions.end());
  for (double& x : net.points) x = std::isfinite(x) ? x : 0.0;  // no polygon has them
  net.peak.resize(first.size());
  for (uint32_t v : polygons.vertices) net.vertex.push_back(first[v]);
  return net;
}

// Texture coordinates and colours, shared by the vertices that agree in position and in them.
Net attribute_net(const MeshData& control, const Polygons& polygons, const std::vector<uint32_t>& first) {
  Net net;
  size_t uv = control.uvs.empty() ? 0 : 2, color = control.colors.empty() ? 0 : 4;
  net.width = uv + color;
  if (net.width == 0) return net;
  for (size_t v = 0; v < first.size(); ++v) {
    for (size_t i = 0; i < uv; ++i) net.points.push_back(control.uvs[2 * v + i]);
    for (size_t i = 0; i < color; ++i) net.points.push_back(control.colors[4 * v + i]);
  }
  std::map<std::pair<uint32_t, std::vector<double>>, uint32_t> known;
  std::vector<uint32_t> same(first.size());
  for (uint32_t v = 0; v < first.size(); ++v) {
    same[v] = v;
    if (first[v] == v) continue;
    same[v] = known.try_emplace({first[v], std::vector<double>(net.at(v), net.at(v) + net.width)}, v).first->second;
    if (std::equal(net.at(v), net.at(v) + net.width, net.at(first[v]))) same[v] = first[v];
  }
  net.peak.resize(first.size());
  for (uint32_t v : polygons.vertices) net.vertex.push_back(same[v]);
  return net;
}

uint32_t vertex_in(const char* list, uint32_t vertex, const std::vector<uint32_t>& first) {
  if (vertex < first.size()) return first[vertex];
  throw BadCrease(list, "names vertex " + std::to_string(vertex) + ", which does not exist: allowed are 0 to " +
                            std::to_string(first.size() - 1));
}

// Sharpness of edges and vertices as the scene asks for it.
void sharpen(const Subdivision& how, const std::vector<uint32_t>& first, Net& net, Faces& faces, const Edges& edges) {
  for (const Peak& peak : how.corners) {
    float& sharpness = net.peak[vertex_in("corners", peak.vertex, first)];
    sharpness = std::max(sharpness, std::min(peak.sharpness, kSharp));
  }
  if (how.creases.empty()) return;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> numbers;
  for (uint32_t c : edges.corner) numbers[std::minmax({net.vertex[c], net.vertex[faces.next(c)]})] = edges.of_corner[c];
  std::vector<float> sharpness(edges.count());
  for (const Crease& crease : how.creases) {
    auto ends = std::minmax({vertex_in("creases", crease.a, first), vertex_in("creases", crease.b, first)});
    auto found = numbers.find(ends);
    if (found == numbers.end()) {
      throw BadCrease("creases", "names vertices " + std::to_string(crease.a) + " and " + std::to_string(crease.b) +
                                     ", which have no edge: allowed are neighbours in a face");
    }
    sharpness[found->second] = std::max(sharpness[found->second], std::min(crease.sharpness, kSharp));
  }
  for (uint32_t c = 0; c < faces.corners(); ++c) faces.sharpness[c] = sharpness[edges.of_corner[c]];
}

// Normal of a polygon, twice its area long (Newell's sum).
std::array<double, 3> newell(const Net& net, const Faces& faces, uint32_t f) {
  std::array<double, 3> n{};
  for (uint32_t c = faces.begin(f); c < faces.end(f); ++c) {
    const double *a = net.at(net.vertex[c]), *b = net.at(net.vertex[faces.next(c)]);
    for (size_t i = 0; i < 3; ++i) n[i] += (a[(i + 1) % 3] - b[(i + 1) % 3]) * (a[(i + 2) % 3] + b[(i + 2) % 3]);
  }
  return n;
}

void sharpen_bends(double least_cosine, const Net& net, Faces& faces, const Edges& edges) {
  if (least_cosine < -1.0) return;
  for (uint32_t c : edges.corner) {
    if (edges.twin[c] == kNone) continue;
    auto a = newell(net, faces, faces.face(c)), b = newell(net, faces, faces.face(edges.twin[c]));
    double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    double sizes = (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    if (dot < least_cosine * std::sqrt(sizes)) faces.sharpness[c] = faces.sharpness[edges.twin[c]] = kSharp;
  }
}

// Corners of positions hold for what is attached there too.
void share_peaks(const Net& from, Net& to) {
  for (size_t c = 0; c < to.vertex.size(); ++c) to.peak[to.vertex[c]] = from.peak[from.vertex[c]];
}

struct Refined {
  Faces faces;
  Net positions, attributes;
  std::vector<double> limits, values;
  LimitNormals normals;
};

Refined refine(Faces faces, Net positions, Net attributes, const Subdivision& how) {
  for (uint32_t level = 0; level < how.levels; ++level) {
    Edges edges(positions, faces);
    if (attributes.width > 0) {
      Edges seams(attributes, faces);
      if (level == 0) pin_lone_corners(attributes, faces, seams);
      attributes = refined(attributes, faces, seams, how.scheme, how.attributes);
    }
    positions = refined(positions, faces, edges, how.scheme, Smoothness::smooth);
    faces = refined(faces, how.scheme);
  }
  Refined result;
  Edges edges(positions, faces);
  result.limits = limit_points(positions, faces, edges, how.scheme);
  result.normals = limit_normals(positions, faces, edges, how.scheme, result.limits);
  if (attributes.width > 0) {
    result.values = how.attributes == Smoothness::smooth
                        ? limit_points(attributes, faces, Edges(attributes, faces), how.scheme)
                        : attributes.points;
  }
  result.faces = std::move(faces);
  result.positions = std::move(positions);
  result.attributes = std::move(attributes);
  return result;
}

// One vertex for each side of a crease and of a seam.
MeshData to_mesh(const Refined& surface, bool has_uvs, bool has_colors) {
  MeshData mesh;
  size_t corners = surface.faces.corners(), width = surface.attributes.width;
  std::vector<uint32_t> vertex(corners);
  std::vector<uint32_t> corner_of;  // a corner of each vertex
  IndexTable table;
  auto value = [&](uint32_t c) { return width > 0 ? surface.attributes.vertex[c] : 0; };
  auto hash = [&](uint32_t c) { return hash_words(surface.normals.of_corner[c], value(c), 0); };
  for (uint32_t c = 0; c < corners; ++c) {
    auto same = [&](uint32_t n) {
      uint32_t d = corner_of[n];
      return surface.normals.of_corner[c] == surface.normals.of_corner[d] && value(c) == value(d);
    };
    uint32_t fresh = static_cast<uint32_t>(corner_of.size());
    vertex[c] = table.find_or_insert(hash(c), fresh, same, [&](uint32_t n) { return hash(corner_of[n]); });
    if (vertex[c] == fresh) corner_of.push_back(c);
  }
  auto append = [](std::vector<float>& target, const double* from, size_t count) {
    for (size_t i = 0; i < count; ++i) target.push_back(static_cast<float>(from[i]));
  };
  for (uint32_t c : corner_of) {
    append(mesh.positions, &surface.limits[3 * size_t{surface.positions.vertex[c]}], 3);
    append(mesh.normals, &surface.normals.normals[3 * size_t{surface.normals.of_corner[c]}], 3);
    if (width == 0) continue;
    const double* values = &surface.values[width * surface.attributes.vertex[c]];
    if (has_uvs) append(mesh.uvs, values, 2);
    if (has_colors) append(mesh.colors, values + width - 4, 4);
  }
  uint32_t sides = surface.faces.sides;
  for (uint32_t f = 0; f < surface.faces.count; ++f) {
    const uint32_t* v = &vertex[size_t{f} * sides];
    for (uint32_t k = 2; k < sides; ++k) mesh.indices.insert(mesh.indices.end(), {v[0], v[k - 1], v[k]});
  }
  return mesh;
}

}  // namespace

uint64_t subdivided_triangles(uint64_t triangles, uint64_t polygons, Scheme scheme, uint32_t levels) {
  // A polygon of n corners is n - 2 triangles of a fan, and n quadrilaterals after the first step.
  uint64_t after_one = scheme == Scheme::loop ? 4 * triangles : 2 * (triangles + 2 * polygons);
  return after_one << (2 * (levels - 1));
}

MeshData subdivide(const MeshData& control, const Subdivision& how) {
  MeshReport report;
  std::vector<uint32_t> first = weld(control.positions);
  Polygons polygons = polygons_of(control, how.scheme, first, report);
  Faces faces = Faces::of_sizes(polygons.sizes);
  Net positions = position_net(control, polygons, first);
  {
    Edges edges(positions, faces);
    sharpen(how, first, positions, faces, edges);
    sharpen_bends(how.least_cosine, positions, faces, edges);
    pin_pinched_vertices(positions, faces, edges);
    pin_lone_corners(positions, faces, edges);
  }
  Net attributes = attribute_net(control, polygons, first);
  share_peaks(positions, attributes);
  MeshData mesh = to_mesh(refine(std::move(faces), std::move(positions), std::move(attributes), how),
                          !control.uvs.empty(), !control.colors.empty());
  mesh.report = report;
  return mesh;
}

}  // namespace accuray::mesh
