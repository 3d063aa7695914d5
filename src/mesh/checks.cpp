#include "mesh/checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "mesh/error.h"
#include "mesh/index_table.h"
#include "mesh/normals.h"

namespace accuray::mesh {
namespace {

using Vec3 = std::array<double, 3>;

bool usable(const float* p) {
  return std::fabs(p[0]) <= kMaxCoordinate && std::fabs(p[1]) <= kMaxCoordinate && std::fabs(p[2]) <= kMaxCoordinate;
}

Vec3 difference(const float* a, const float* b) {
  return {double{a[0]} - double{b[0]}, double{a[1]} - double{b[1]}, double{a[2]} - double{b[2]}};
}

double squared(const Vec3& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

bool has_area(const float* a, const float* b, const float* c) {
  constexpr double tolerance = 0x1p-50;
  Vec3 u = difference(b, a), v = difference(c, b), w = difference(a, c);
  Vec3 cross{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  // Twice the area against the product of the two shorter edges, all squared: that ratio is the sine between them.
  double uu = squared(u), vv = squared(v), ww = squared(w);
  double shorter = std::min({uu * vv, vv * ww, ww * uu});
  return squared(cross) > tolerance * tolerance * shorter;
}

void drop_triangles(MeshData& mesh) {
  const float* p = mesh.positions.data();
  auto vertex = [&](size_t corner) { return p + 3 * size_t{mesh.indices[corner]}; };
  size_t kept = 0;
  for (size_t corner = 0; corner < mesh.indices.size(); corner += 3) {
    const float *a = vertex(corner), *b = vertex(corner + 1), *c = vertex(corner + 2);
    if (!usable(a) || !usable(b) || !usable(c)) {
      ++mesh.report.nonfinite_triangles;
    } else if (!has_area(a, b, c)) {
      ++mesh.report.degenerate_triangles;
    } else {
      for (size_t i = 0; i < 3; ++i) mesh.indices[kept + i] = mesh.indices[corner + i];
      if (!mesh.materials.empty()) mesh.materials[kept / 3] = mesh.materials[corner / 3];
      if (!mesh.smoothing_groups.empty()) mesh.smoothing_groups[kept / 3] = mesh.smoothing_groups[corner / 3];
      kept += 3;
    }
  }
  mesh.indices.resize(kept);
  if (!mesh.materials.empty()) mesh.materials.resize(kept / 3);
  if (!mesh.smoothing_groups.empty()) mesh.smoothing_groups.resize(kept / 3);
}

// Moves the entries of `values`, `width` per vertex, to their new numbers.
void renumber(std::vector<float>& values, size_t width, const std::vector<uint32_t>& number, size_t count) {
  if (values.empty()) return;
  for (size_t i = 0; i < number.size(); ++i) {
    if (number[i] == kNone) continue;
    for (size_t j = 0; j < width; ++j) values[number[i] * width + j] = values[i * width + j];
  }
  values.resize(count * width);
}

void drop_vertices(MeshData& mesh) {
  size_t vertices = mesh.positions.size() / 3;
  for (size_t i = 0; i < vertices; ++i) mesh.report.nonfinite_vertices += usable(&mesh.positions[3 * i]) ? 0 : 1;
  if (mesh.report.nonfinite_vertices == 0) return;

  std::vector<uint32_t> number(vertices, kNone);
  for (uint32_t index : mesh.indices) number[index] = 0;
  uint32_t count = 0;
  for (uint32_t& n : number) {
    if (n != kNone) n = count++;
  }
  renumber(mesh.positions, 3, number, count);
  renumber(mesh.normals, 3, number, count);
  renumber(mesh.uvs, 2, number, count);
  renumber(mesh.colors, 4, number, count);
  for (uint32_t& index : mesh.indices) index = number[index];
}

// Lengths that a unit vector has after its rounding to floats; such normals stay as they are, so that a mesh that is
// written and read again has the same bits.
constexpr double kUnit = 0x1p-23;

void repair_normals(MeshData& mesh) {
  uint64_t bad = 0;
  for (size_t i = 0; i < mesh.normals.size(); i += 3) {
    float* n = &mesh.normals[i];
    double length = std::sqrt(squared({n[0], n[1], n[2]}));
    bool good = std::isfinite(length) && length > 0.0;
    if (!(std::fabs(length - 1.0) <= kUnit)) {
      for (size_t j = 0; j < 3; ++j) n[j] = good ? static_cast<float>(n[j] / length) : 0.0f;
    }
    bad += good ? 0 : 1;
  }
  mesh.report.generated_normals += bad;
  if (bad == 0) return;
  std::vector<float> smooth = smooth_normals(mesh.positions, mesh.indices);
  for (size_t i = 0; i < mesh.normals.size(); i += 3) {
    float* n = &mesh.normals[i];
    if (n[0] == 0.0f && n[1] == 0.0f && n[2] == 0.0f) std::copy_n(&smooth[i], 3, n);
  }
}

void repair_uvs(MeshData& mesh) {
  for (size_t i = 0; i < mesh.uvs.size(); i += 2) {
    if (std::isfinite(mesh.uvs[i]) && std::isfinite(mesh.uvs[i + 1])) continue;
    mesh.uvs[i] = mesh.uvs[i + 1] = 0.0f;
    ++mesh.report.missing_uvs;
  }
}

void repair_colors(MeshData& mesh) {
  for (size_t i = 0; i < mesh.colors.size(); i += 4) {
    float* color = &mesh.colors[i];
    if (std::all_of(color, color + 4, [](float x) { return std::isfinite(x); })) continue;
    std::fill_n(color, 4, 1.0f);
    ++mesh.report.missing_colors;
  }
}

}  // namespace

void require_indices_in_range(const MeshData& mesh, std::string_view name) {
  size_t vertices = mesh.positions.size() / 3;
  auto bad = std::find_if(mesh.indices.begin(), mesh.indices.end(), [&](uint32_t index) { return index >= vertices; });
  if (bad == mesh.indices.end()) return;
  std::string subject = std::string("vertex index of triangle ") + std::to_string((bad - mesh.indices.begin()) / 3);
  std::string allowed =
      vertices == 0 ? "none, for there are no vertices" : std::string("0 to ") + std::to_string(vertices - 1);
  throw ReadError(name, {}, subject, std::to_string(*bad), "is out of range", allowed);
}

void repair(MeshData& mesh) {
  mesh.report.triangles_read = mesh.indices.size() / 3;
  if (mesh.polygons.empty()) {
    drop_triangles(mesh);
    drop_vertices(mesh);
    repair_normals(mesh);
  } else {
    mesh.normals.clear();
  }
  repair_uvs(mesh);
  repair_colors(mesh);
}

}  // namespace accuray::mesh
