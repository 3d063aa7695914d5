#include "lower/vertices.h"

#include <algorithm>
#include <new>
#include <stdexcept>

namespace accuray {

namespace {

constexpr std::align_val_t cache_line{64};
// Embree reads 16 bytes at the last position.
constexpr size_t room = 16 / sizeof(float);

struct Release {
  void operator()(float* values) const { ::operator delete(values, cache_line); }
};

}  // namespace

Section interleave(const MeshArrays& arrays, Mesh& mesh) {
  const size_t count = arrays.vertex_count();
  mesh.vertex_count = static_cast<uint32_t>(count);
  mesh.segments = arrays.segments;
  mesh.normal = arrays.normals.empty() ? 0u : 3u;
  mesh.uv = arrays.uvs.empty() ? 0u : 3u + mesh.normal;
  mesh.stride = 3u + mesh.normal + (mesh.uv != 0 ? 2u : 0u);
  const size_t size = mesh.floats_per_key() * (arrays.segments + 1);
  if (size > UINT32_MAX)
    throw std::invalid_argument("has too many vertices: allowed are 4 294 967 295 numbers for all");
  auto* values = static_cast<float*>(::operator new((size + room) * sizeof(float), cache_line));
  const std::shared_ptr<const void> owner(values, Release{});
  for (size_t row = 0; row < count * (arrays.segments + 1); ++row) {
    float* vertex = values + mesh.stride * row;
    std::copy_n(arrays.positions.data() + 3 * row, 3, vertex);
    if (mesh.normal != 0) std::copy_n(arrays.normals.data() + 3 * row, 3, vertex + mesh.normal);
    if (mesh.uv != 0) std::copy_n(arrays.uvs.data() + 2 * (row % count), 2, vertex + mesh.uv);
  }
  std::fill_n(values + size, room, 0.0f);
  return {owner, reinterpret_cast<const uint8_t*>(values), size * sizeof(float)};
}

std::vector<float> positions_of(const Mesh& mesh, const float* vertices) {
  std::vector<float> positions(size_t{3} * mesh.vertex_count);
  for (size_t i = 0; i < mesh.vertex_count; ++i) std::copy_n(vertices + mesh.stride * i, 3, positions.data() + 3 * i);
  return positions;
}

}  // namespace accuray
