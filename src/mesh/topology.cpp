#include "mesh/topology.h"

#include <algorithm>
#include <utility>

#include "mesh/index_table.h"

namespace accuray::mesh {

Faces Faces::of_sizes(std::span<const uint32_t> sizes) {
  Faces faces;
  faces.count = static_cast<uint32_t>(sizes.size());
  faces.first.reserve(sizes.size() + 1);
  faces.first.push_back(0);
  for (uint32_t size : sizes) {
    faces.face_of.insert(faces.face_of.end(), size, static_cast<uint32_t>(faces.first.size() - 1));
    faces.first.push_back(faces.first.back() + size);
  }
  faces.sharpness.resize(faces.first.back());
  return faces;
}

Edges::Edges(const Net& net, const Faces& faces) : of_corner(faces.corners()), twin(faces.corners(), kNone) {
  IndexTable table;
  std::vector<std::pair<uint32_t, uint32_t>> ends;  // the lower vertex first
  std::vector<uint32_t> uses;
  std::vector<uint32_t> other;  // a second corner of each edge
  auto hash = [&](const std::pair<uint32_t, uint32_t>& e) { return hash_words(e.first, e.second, 0); };
  for (uint32_t c = 0; c < faces.corners(); ++c) {
    auto key = std::minmax(net.vertex[c], net.vertex[faces.next(c)]);
    std::pair<uint32_t, uint32_t> end = {key.first, key.second};
    uint32_t fresh = static_cast<uint32_t>(ends.size());
    uint32_t e = table.find_or_insert(
        hash(end), fresh, [&](uint32_t n) { return ends[n] == end; }, [&](uint32_t n) { return hash(ends[n]); });
    if (e == fresh) {
      ends.push_back(end);
      corner.push_back(c);
      uses.push_back(0);
      other.push_back(c);
    }
    ++uses[e];
    other[e] = c;
    of_corner[c] = e;
  }
  for (uint32_t e = 0; e < count(); ++e) {
    uint32_t a = corner[e], b = other[e];
    if (uses[e] != 2 || net.vertex[a] == net.vertex[b]) continue;
    twin[a] = b;
    twin[b] = a;
  }
}

float Edges::sharpness(const Faces& faces, uint32_t c) const { return twin[c] == kNone ? kSharp : faces.sharpness[c]; }

void pin_pinched_vertices(Net& net, const Faces& faces, const Edges& edges) {
  std::vector<bool> seen(faces.corners());
  std::vector<uint8_t> fans(net.vertices()), closed(net.vertices());
  for (uint32_t start = 0; start < faces.corners(); ++start) {
    if (seen[start]) continue;
    uint32_t first = start;
    for (uint32_t right = edges.twin[first]; right != kNone; right = edges.twin[first]) {
      first = faces.next(right);
      if (first == start) break;
    }
    uint32_t c = first;
    do {
      seen[c] = true;
      c = turned_left(faces, edges, c);
    } while (c != kNone && c != first);
    uint32_t v = net.vertex[start];
    fans[v] = static_cast<uint8_t>(std::min(fans[v] + 1, 2));
    closed[v] |= c == kNone ? 0 : 1;
  }
  for (uint32_t v = 0; v < net.vertices(); ++v) {
    if (fans[v] > 1 && closed[v] != 0) net.peak[v] = kSharp;
  }
}

void pin_lone_corners(Net& net, const Faces& faces, const Edges& edges) {
  std::vector<uint8_t> polygons(net.vertices());
  for (uint32_t v : net.vertex) polygons[v] = static_cast<uint8_t>(std::min(polygons[v] + 1, 2));
  for (uint32_t c = 0; c < faces.corners(); ++c) {
    if (polygons[net.vertex[c]] == 1 && edges.twin[c] == kNone) net.peak[net.vertex[c]] = kSharp;
  }
}

}  // namespace accuray::mesh
