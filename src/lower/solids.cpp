#include "lower/solids.h"

#include <numeric>

#include "kernels/geometry/shapes.h"
#include "kernels/math/functions.h"
#include "lower/grid.h"
#include "lower/teapot.h"
#include "mesh/checks.h"

namespace accuray {

namespace {

using mesh::MeshData;

uint32_t count_of(const Values& values, std::string_view name) {
  return static_cast<uint32_t>(number_of(values, name));
}
bool is_smooth(const Values& values) { return number_of(values, "shading") == 0.0; }

void require_at_most(uint64_t triangles) {
  if (triangles > max_triangles) {
    throw std::invalid_argument("segments make " + std::to_string(triangles) + " triangles: allowed are up to " +
                                std::to_string(max_triangles));
  }
}

// Sine and cosine of k / n of a turn. The quadrant is removed exactly, so that opposite points are exactly opposite.
SinCosDouble turn(uint64_t k, uint64_t n) {
  const auto quadrant = static_cast<int64_t>((8 * (k % n) + n) / (2 * n));
  const int64_t rest = static_cast<int64_t>(4 * (k % n)) - quadrant * static_cast<int64_t>(n);
  const SinCosDouble r = sincos(0x1.921fb54442d18p+0 * static_cast<double>(rest) / static_cast<double>(n));
  switch (quadrant % 4) {
    case 0:
      return r;
    case 1:
      return {r.cos, -r.sin};
    case 2:
      return {-r.sin, -r.cos};
    default:
      return {-r.cos, r.sin};
  }
}

std::vector<SinCosDouble> turns(uint32_t n) {
  std::vector<SinCosDouble> result(n);
  for (uint32_t k = 0; k < n; ++k) result[k] = turn(k, n);
  return result;
}

// Right-handed and orthonormal, z along the given axis; about +Y an angle runs from +X to -Z.
struct Axes {
  Double3 x, y, z;
  Double3 around(const SinCosDouble& angle) const { return combined(angle.cos, x, angle.sin, y); }
};

Axes axes_along(const Double3& direction, const char* name) {
  const double size = length(direction);
  if (!(size > 0.0 && size < 1e150))
    throw std::invalid_argument(std::string(name) + " has no direction: allowed is any length but zero");
  const Double3 z = scaled(1.0 / size, direction);
  size_t least = 0;
  for (size_t k = 1; k < 3; ++k) least = std::fabs(z[k]) < std::fabs(z[least]) ? k : least;
  Double3 x = scaled(-z[least], z);
  x[least] += 1.0;
  x = scaled(1.0 / length(x), x);
  return {x, cross(z, x), z};
}

MeshData cube(const Values& values) {
  const auto center = vec_of(values, "center");
  const auto size = vec_of(values, "size");
  MeshData mesh;
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      // u and v run so that their cross product points outside.
      const size_t u = (axis + (side > 0.0 ? 1 : 2)) % 3;
      const size_t v = 3 - axis - u;
      add_grid(mesh, 1, 1, false, false, [&](uint32_t i, uint32_t j) {
        Double3 p = center;
        p[axis] += 0.5 * side * size[axis];
        p[u] += (static_cast<double>(i) - 0.5) * size[u];
        p[v] += (static_cast<double>(j) - 0.5) * size[v];
        return GridPoint{p, {}};
      });
    }
  }
  return mesh;
}

// One end of a cylinder: a fan around its centre. `side` 1: the end, -1: the start.
void add_cap(MeshData& mesh, const Axes& axes, const Double3& center, double radius, double side,
             const std::vector<SinCosDouble>& angles, bool smooth) {
  const auto first = static_cast<uint32_t>(mesh.positions.size() / 3);
  const auto n = static_cast<uint32_t>(angles.size());
  const auto add = [&](const Double3& p, double s, double t) {
    for (const double x : p) mesh.positions.push_back(static_cast<float>(x));
    for (const double x : axes.z) {
      if (smooth) mesh.normals.push_back(static_cast<float>(side * x));
    }
    mesh.uvs.push_back(static_cast<float>(0.5 + 0.5 * s));
    mesh.uvs.push_back(static_cast<float>(0.5 + 0.5 * side * t));
  };
  add(center, 0.0, 0.0);
  for (const SinCosDouble& angle : angles) {
    add(sum(center, scaled(radius, axes.around(angle))), angle.cos, angle.sin);
  }
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t a = first + 1 + i;
    const uint32_t b = first + 1 + (i + 1) % n;
    mesh.indices.insert(mesh.indices.end(), {first, side > 0.0 ? a : b, side > 0.0 ? b : a});
  }
}

MeshData cylinder(const Values& values) {
  const auto start = vec_of(values, "start");
  const auto end = vec_of(values, "end");
  const double radius = number_of(values, "radius");
  const bool smooth = is_smooth(values);
  const Double3 along = difference(end, start);
  if (!(length(along) > 0.0)) throw std::invalid_argument("start and end are the same point: they must differ");
  const Axes axes = axes_along(along, "the line from start to end");
  const auto angles = turns(count_of(values, "segments"));
  const auto n = static_cast<uint32_t>(angles.size());
  MeshData mesh;
  add_grid(mesh, n, 1, smooth, false, [&](uint32_t i, uint32_t j) {
    const Double3 normal = axes.around(angles[i % n]);
    return GridPoint{sum(j == 0 ? start : end, scaled(radius, normal)), normal};
  });
  if (number_of(values, "caps") != 0.0) {
    add_cap(mesh, axes, start, radius, -1.0, angles, smooth);
    add_cap(mesh, axes, end, radius, 1.0, angles, smooth);
  }
  return mesh;
}

MeshData torus(const Values& values) {
  const auto center = vec_of(values, "center");
  const Axes axes = axes_along(vec_of(values, "axis"), "axis");
  const double radius = number_of(values, "radius");
  const double tube = number_of(values, "tube_radius");
  if (!(tube < radius)) throw std::invalid_argument("tube_radius must be less than radius");
  const uint32_t nu = count_of(values, "segments");
  const uint32_t nv = count_of(values, "tube_segments");
  require_at_most(uint64_t{2} * nu * nv);
  const auto ring = turns(nu);
  const auto section = turns(nv);
  MeshData mesh;
  add_grid(mesh, nu, nv, is_smooth(values), false, [&](uint32_t i, uint32_t j) {
    const Double3 outward = axes.around(ring[i % nu]);
    const SinCosDouble& angle = section[j % nv];
    const Double3 normal = combined(angle.cos, outward, angle.sin, axes.z);
    return GridPoint{sum(center, combined(radius, outward, tube, normal)), normal};
  });
  return mesh;
}

// A point of the curve on the torus, and two unit vectors across it: the torus's normal, which closes after one round
// as a Frenet frame need not, and its cross product with the tangent.
struct KnotFrame {
  Double3 point, normal, binormal;
  double curvature;
};

// Curve and derivatives with c = cos(q t), s = sin(q t): r the direction from the axis, f = dr/d(p t).
KnotFrame knot_frame(const Axes& axes, const Double3& center, double radius, double winding, double p, double q,
                     const SinCosDouble& long_way, const SinCosDouble& short_way) {
  const double c = short_way.cos;
  const double s = short_way.sin;
  const Double3 r = axes.around(long_way);
  const Double3 f = combined(long_way.cos, axes.y, -long_way.sin, axes.x);
  const Double3 normal = combined(c, r, s, axes.z);
  const double reach = radius + winding * c;
  const Double3 velocity = sum(scaled(p * reach, f), scaled(q * winding, combined(-s, r, c, axes.z)));
  const Double3 acceleration =
      sum(combined(-2.0 * p * q * winding * s, f, -p * p * reach, r), scaled(-q * q * winding, normal));
  const double speed = length(velocity);
  return {sum(center, combined(radius, r, winding, normal)), normal, scaled(1.0 / speed, cross(normal, velocity)),
          length(cross(velocity, acceleration)) / (speed * speed * speed)};
}

MeshData torus_knot(const Values& values) {
  const Axes axes = axes_along(vec_of(values, "axis"), "axis");
  const double radius = number_of(values, "radius");
  const double winding = number_of(values, "winding_radius");
  const double tube = number_of(values, "tube_radius");
  const uint32_t p = count_of(values, "p");
  const uint32_t q = count_of(values, "q");
  if (!(winding < radius)) throw std::invalid_argument("winding_radius must be less than radius");
  if (std::gcd(p, q) != 1) throw std::invalid_argument("p and q have a common factor: the curve would repeat itself");
  const uint32_t nu = count_of(values, "segments");
  const uint32_t nv = count_of(values, "tube_segments");
  require_at_most(uint64_t{2} * nu * nv);
  std::vector<KnotFrame> frames;
  frames.reserve(nu);
  for (uint64_t i = 0; i < nu; ++i) {
    frames.push_back(
        knot_frame(axes, vec_of(values, "center"), radius, winding, p, q, turn(i * p, nu), turn(i * q, nu)));
    if (tube * frames.back().curvature >= 1.0) {
      throw std::invalid_argument("tube_radius must be less than the radius of the tightest bend, which is at most " +
                                  std::to_string(1.0 / frames.back().curvature));
    }
  }
  const auto section = turns(nv);
  MeshData mesh;
  add_grid(mesh, nu, nv, is_smooth(values), false, [&](uint32_t i, uint32_t j) {
    const KnotFrame& frame = frames[i % nu];
    const SinCosDouble& angle = section[j % nv];
    const Double3 normal = combined(angle.cos, frame.normal, angle.sin, frame.binormal);
    return GridPoint{sum(frame.point, scaled(tube, normal)), normal};
  });
  return mesh;
}

MeshData teapot(const Values& values, std::span<const double> newell) {
  const uint32_t segments = count_of(values, "segments");
  require_at_most(uint64_t{64} * segments * segments);
  return teapot_mesh(newell, vec_of(values, "center"), number_of(values, "height"), segments, is_smooth(values));
}

}  // namespace

MeshData rectangle_mesh(const Values& values) {
  const auto c = vec_of(values, "corner");
  const auto u = vec_of(values, "edge_u");
  const auto v = vec_of(values, "edge_v");
  // The sine of their angle, squared.
  const Vec3 x = to_vec3(u);
  const Vec3 y = to_vec3(v);
  const float sine2 = length_squared(cross(x, y)) / (length_squared(x) * length_squared(y));
  if (!(sine2 > 1e-12f))
    throw std::invalid_argument("edge_u and edge_v span no area: they must not be zero or parallel");
  MeshData mesh;
  for (const auto& [s, t] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) {
    for (size_t k = 0; k < 3; ++k) mesh.positions.push_back(static_cast<float>(c[k] + s * u[k] + t * v[k]));
    mesh.uvs.push_back(static_cast<float>(s));
    mesh.uvs.push_back(static_cast<float>(t));
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

MeshData tessellate(std::string_view type, const Values& values, std::span<const double> newell) {
  MeshData mesh;
  if (type == Cube::name) {
    mesh = cube(values);
  } else if (type == Cylinder::name) {
    mesh = cylinder(values);
  } else if (type == Torus::name) {
    mesh = torus(values);
  } else if (type == TorusKnot::name) {
    mesh = torus_knot(values);
  } else if (type == Teapot::name) {
    mesh = teapot(values, newell);
  } else if (type == Rectangle::name) {
    mesh = rectangle_mesh(values);
  } else {
    throw std::invalid_argument("'" + std::string(type) + "' is no shape of this kind");
  }
  mesh::repair(mesh);
  if (mesh.report.nonfinite_triangles != 0) throw std::invalid_argument("coordinates exceed 1e18 m");
  if (mesh.report.degenerate_triangles != 0)
    throw std::invalid_argument("size is lost in the rounding of the coordinates: some triangles have no area");
  return mesh;
}

}  // namespace accuray
