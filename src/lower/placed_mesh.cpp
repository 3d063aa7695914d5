#include "lower/placed_mesh.h"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <utility>

namespace accuray {

namespace {

// Sections of vertices begin at cache lines, so that no vertex of 32 bytes lies in two.
constexpr std::align_val_t cache_line{64};
// Embree reads 16 bytes at the last position.
constexpr size_t room = 16 / sizeof(float);

struct Release {
  void operator()(float* values) const { ::operator delete(values, cache_line); }
};

Section interleave(const MeshArrays& arrays, Mesh& mesh) {
  const size_t count = arrays.vertex_count();
  const size_t rows = count * (arrays.segments + 1);
  mesh.vertex_count = static_cast<uint32_t>(count);
  mesh.segments = arrays.segments;
  mesh.normal = arrays.normals.empty() ? 0u : 3u;
  mesh.uv = arrays.uvs.empty() ? 0u : 3u + mesh.normal;
  mesh.stride = 3u + mesh.normal + (mesh.uv != 0 ? 2u : 0u);
  const size_t size = rows * mesh.stride;
  if (size > UINT32_MAX)
    throw std::invalid_argument("has too many vertices: allowed are 4 294 967 295 numbers for all");
  if (size == 0) return {};
  auto* values = static_cast<float*>(::operator new((size + room) * sizeof(float), cache_line));
  const std::shared_ptr<const void> owner(values, Release{});
  for (size_t row = 0; row < rows; ++row) {
    float* vertex = values + mesh.stride * row;
    std::copy_n(arrays.positions.data() + 3 * row, 3, vertex);
    if (mesh.normal != 0) std::copy_n(arrays.normals.data() + 3 * row, 3, vertex + mesh.normal);
    if (mesh.uv != 0) std::copy_n(arrays.uvs.data() + 2 * (row % count), 2, vertex + mesh.uv);
  }
  std::fill_n(values + size, room, 0.0f);
  return {owner, reinterpret_cast<const uint8_t*>(values), size * sizeof(float)};
}

template <class T>
Section section_or_none(std::vector<T> values) {
  return values.empty() ? Section{} : section_of(std::move(values));
}

}  // namespace

void move_mesh(const Matrix& m, MeshArrays& mesh) {
  transform_array<true>(m, mesh.positions);
  if (is_similarity(m)) {
    transform_array<false>(m, mesh.normals);
  } else {
    transform_normals(m, mesh.normals);
  }
  if (determinant(m) < 0.0) {
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  }
}

PlacedMesh place_mesh(MeshArrays arrays, const std::optional<Matrix>& transform) {
  if (transform) move_mesh(*transform, arrays);
  PlacedMesh mesh;
  for (size_t i = 0; i + 2 < arrays.positions.size(); i += 3) {
    mesh.bounds.grow(Vec3{arrays.positions[i], arrays.positions[i + 1], arrays.positions[i + 2]});
  }
  mesh.vertices = interleave(arrays, mesh.layout);
  mesh.indices = section_or_none(std::move(arrays.indices));
  mesh.colors = section_or_none(std::move(arrays.colors));
  return mesh;
}

std::vector<float> positions_of(const Mesh& mesh, const uint8_t* vertices) {
  const auto* values = reinterpret_cast<const float*>(vertices);
  std::vector<float> positions(size_t{3} * mesh.vertex_count);
  for (size_t i = 0; i < mesh.vertex_count; ++i) std::copy_n(values + mesh.stride * i, 3, positions.data() + 3 * i);
  return positions;
}

}  // namespace accuray
