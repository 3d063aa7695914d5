#include "mesh/displacement.h"

#include <array>
#include <cmath>

#include "mesh/normals.h"
#include "mesh/weld.h"

namespace accuray::mesh {
namespace {

using Vec3 = std::array<double, 3>;

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec3 at(std::span<const float> values, size_t i) { return {values[3 * i], values[3 * i + 1], values[3 * i + 2]}; }

// Sums over the triangles of each vertex: directions in which u and v grow, weighted by area in the texture.
struct Directions {
  std::vector<Vec3> u, v;

  explicit Directions(const MeshData& mesh) : u(mesh.positions.size() / 3), v(u.size()) {
    for (size_t corner = 0; corner < mesh.indices.size(); corner += 3) {
      const uint32_t* i = &mesh.indices[corner];
      Vec3 p = at(mesh.positions, i[0]), b = at(mesh.positions, i[1]), c = at(mesh.positions, i[2]);
      auto uv = [&](int k, size_t axis) {
        return double{mesh.uvs[2 * size_t{i[k]} + axis]} - mesh.uvs[2 * size_t{i[0]} + axis];
      };
      double sign = uv(1, 0) * uv(2, 1) - uv(1, 1) * uv(2, 0) < 0.0 ? -1.0 : 1.0;
      for (size_t axis = 0; axis < 3; ++axis) {
        double du = sign * ((b[axis] - p[axis]) * uv(2, 1) - (c[axis] - p[axis]) * uv(1, 1));
        double dv = sign * ((c[axis] - p[axis]) * uv(1, 0) - (b[axis] - p[axis]) * uv(2, 0));
        for (size_t k = 0; k < 3; ++k) {
          u[i[k]][axis] += du;
          v[i[k]][axis] += dv;
        }
      }
    }
  }
};

// Unit tangent in the direction of u, or any one.
Vec3 tangent_of(const Vec3& u, const Vec3& n) {
  double along = dot(u, n);
  Vec3 t = {u[0] - along * n[0], u[1] - along * n[1], u[2] - along * n[2]};
  double size = std::sqrt(dot(t, t));
  if (!(size > 1e-9 * std::sqrt(dot(u, u)))) {
    t = std::fabs(n[0]) < 0.7 ? Vec3{0.0, n[2], -n[1]} : Vec3{-n[2], 0.0, n[0]};
    size = std::sqrt(dot(t, t));
  }
  return {t[0] / size, t[1] / size, t[2] / size};
}

// Offsets along the axes of the mesh.
std::vector<Vec3> ways(const MeshData& mesh, std::span<const float> offsets, DisplacementSpace space) {
  size_t vertices = mesh.positions.size() / 3;
  std::vector<Vec3> result(vertices);
  std::vector<float> made;
  if (mesh.normals.empty() && space != DisplacementSpace::object) made = smooth_normals(mesh.positions, mesh.indices);
  std::span<const float> normals = mesh.normals.empty() ? std::span<const float>(made) : mesh.normals;
  if (space == DisplacementSpace::tangent) {
    Directions directions(mesh);
    for (size_t i = 0; i < vertices; ++i) {
      Vec3 n = at(normals, i), t = tangent_of(directions.u[i], n), b = cross(n, t), o = at(offsets, i);
      if (dot(b, directions.v[i]) < 0.0) b = {-b[0], -b[1], -b[2]};
      for (size_t k = 0; k < 3; ++k) result[i][k] = o[0] * t[k] + o[1] * b[k] + o[2] * n[k];
    }
    return result;
  }
  for (size_t i = 0; i < vertices; ++i) {
    Vec3 o = at(offsets, i);
    Vec3 n = space == DisplacementSpace::normal ? at(normals, i) : o;
    double length = space == DisplacementSpace::normal ? o[0] : 1.0;
    for (size_t k = 0; k < 3; ++k) result[i][k] = length * n[k];
  }
  return result;
}

}  // namespace

std::vector<float> displaced(const MeshData& mesh, std::span<const float> offsets, DisplacementSpace space) {
  std::vector<Vec3> way = ways(mesh, offsets, space);
  std::vector<uint32_t> first = weld(mesh.positions);
  std::vector<uint32_t> count(first.size());
  for (size_t i = 0; i < first.size(); ++i) {
    ++count[first[i]];
    if (first[i] == i) continue;
    for (size_t k = 0; k < 3; ++k) way[first[i]][k] += way[i][k];
  }
  std::vector<float> result(mesh.positions.size());
  for (size_t i = 0; i < first.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) {
      result[3 * i + k] = static_cast<float>(mesh.positions[3 * i + k] + way[first[i]][k] / count[first[i]]);
    }
  }
  return result;
}

}  // namespace accuray::mesh
