// A grid of points on a surface as triangles.
#pragma once

#include "lower/double3.h"
#include "mesh/mesh.h"

namespace accuray {

struct GridPoint {
  Double3 position;
  Double3 normal;  // any length but zero
};

// Triangles that the grids of one shape may have together: 10 million are about 700 MB while they are lowered.
inline constexpr uint64_t max_triangles = 10'000'000;

// Adds nu x nv cells with a vertex at each corner (i, j), 0 <= i <= nu, 0 <= j <= nv: `point(i, j)` with the texture
// coordinates (i / nu, j / nv). The front is the side of dp/du x dp/dv. Normals are added if `smooth`. If `pole`, the
// row j = 0 is a single point, and each of its cells one triangle.
template <class Point>
void add_grid(mesh::MeshData& mesh, uint32_t nu, uint32_t nv, bool smooth, bool pole, Point point) {
  const auto first = static_cast<uint32_t>(mesh.positions.size() / 3);
  for (uint32_t j = 0; j <= nv; ++j) {
    for (uint32_t i = 0; i <= nu; ++i) {
      const GridPoint p = point(i, j);
      for (const double x : p.position) mesh.positions.push_back(static_cast<float>(x));
      if (smooth) {
        const double scale = 1.0 / length(p.normal);
        for (const double x : p.normal) mesh.normals.push_back(static_cast<float>(x * scale));
      }
      mesh.uvs.push_back(static_cast<float>(static_cast<double>(i) / nu));
      mesh.uvs.push_back(static_cast<float>(static_cast<double>(j) / nv));
    }
  }
  for (uint32_t j = 0; j < nv; ++j) {
    for (uint32_t i = 0; i < nu; ++i) {
      const uint32_t a = first + j * (nu + 1) + i;
      const uint32_t d = a + nu + 1;
      if (!pole || j > 0) mesh.indices.insert(mesh.indices.end(), {a, a + 1, d + 1});
      mesh.indices.insert(mesh.indices.end(), {a, d + 1, d});
    }
  }
}

}  // namespace accuray
