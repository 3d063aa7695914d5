// Subdivision surfaces, the splitting of long edges, and displacement.
#include <nanobind/stl/array.h>

#include <algorithm>

#include "bindings/py_mesh.h"
#include "mesh/checks.h"
#include "mesh/displacement.h"
#include "mesh/splitting.h"
#include "mesh/subdivision.h"

namespace accuray::bindings {

namespace {

using Positions = Rows<float, 3>;
using Indices = Rows<uint32_t, 3>;
using OptionalUvs = std::optional<Rows<float, 2>>;
using OptionalColors = std::optional<Rows<float, 4>>;

mesh::MeshData to_mesh(const Positions& positions, const Indices& indices, const std::optional<Positions>& normals,
                       const OptionalUvs& uvs, const OptionalColors& colors) {
  mesh::MeshData data;
  data.positions = to_vector(positions);
  data.indices = to_vector(indices);
  if (normals) data.normals = to_vector(*normals);
  if (uvs) data.uvs = to_vector(*uvs);
  if (colors) data.colors = to_vector(*colors);
  const size_t rows = positions.shape(0);
  if ((normals && normals->shape(0) != rows) || (uvs && uvs->shape(0) != rows) || (colors && colors->shape(0) != rows))
    throw std::invalid_argument("normals, uvs and colors need one row for each position");
  mesh::require_indices_in_range(data, "<arrays>");
  return data;
}

using OptionalSizes = std::optional<Column<uint32_t>>;

void set_polygons(mesh::MeshData& data, const OptionalSizes& polygons) {
  if (!polygons) return;
  data.polygons = to_vector(*polygons);
  uint64_t triangles = 0;
  bool good = true;
  for (const uint32_t size : data.polygons) {
    good = good && size >= 3;
    triangles += uint64_t{size} - 2;
  }
  if (!good || 3 * triangles != data.indices.size())
    throw std::invalid_argument("the polygons are not those of the triangles");
}

mesh::Scheme scheme_named(const std::string& name) {
  if (name == "catmull_clark") return mesh::Scheme::catmull_clark;
  if (name == "loop") return mesh::Scheme::loop;
  throw std::invalid_argument("'" + name + "' is no scheme of subdivision");
}

uint64_t subdivided_triangles(uint64_t triangles, const OptionalSizes& polygons, const std::string& scheme,
                              uint32_t levels) {
  return mesh::subdivided_triangles(triangles, polygons ? polygons->size() : triangles, scheme_named(scheme), levels);
}

// Rows of creases: two vertices and a sharpness; of corners: a vertex and a sharpness.
PyMesh subdivide(const Positions& positions, const Indices& indices, const OptionalSizes& polygons,
                 const OptionalUvs& uvs, const OptionalColors& colors, const std::string& scheme, uint32_t levels,
                 bool smooth_uvs, const std::optional<Positions>& creases, const OptionalUvs& corners,
                 double least_cosine) {
  if (levels < 1) throw std::invalid_argument("a surface is subdivided once at least");
  mesh::MeshData control = to_mesh(positions, indices, std::nullopt, uvs, colors);
  set_polygons(control, polygons);
  mesh::Subdivision how;
  how.scheme = scheme_named(scheme);
  how.levels = levels;
  how.attributes = smooth_uvs ? mesh::Smoothness::smooth : mesh::Smoothness::linear;
  how.least_cosine = least_cosine;
  for (size_t i = 0; creases && i < creases->shape(0); ++i) {
    const float* row = creases->data() + 3 * i;
    how.creases.push_back({static_cast<uint32_t>(row[0]), static_cast<uint32_t>(row[1]), row[2]});
  }
  for (size_t i = 0; corners && i < corners->shape(0); ++i) {
    const float* row = corners->data() + 2 * i;
    how.corners.push_back({static_cast<uint32_t>(row[0]), row[1]});
  }
  mesh::MeshData surface;
  {
    const nb::gil_scoped_release release;
    surface = mesh::subdivide(control, how);
  }
  return to_python(std::move(surface));
}

// The length in pixels of each triangle's three edges; `transform`: 3 rows of 4 from the mesh to the world.
nb::object lengths_in_view(const Positions& positions, const Indices& indices, const mesh::View& view,
                           const std::optional<std::array<double, 12>>& transform, bool facing) {
  mesh::View seen = view;
  for (size_t row = 0; transform && row < 12; row += 4) {
    const double* axis = &view.to_camera[row];
    for (size_t k = 0; k < 4; ++k) {
      const double* column = transform->data() + k;
      seen.to_camera[row + k] =
          axis[0] * column[0] + axis[1] * column[4] + axis[2] * column[8] + (k == 3 ? axis[3] : 0.0);
    }
  }
  return to_numpy(mesh::lengths_in_view({positions.data(), positions.size()}, {indices.data(), indices.size()}, seen,
                                        facing ? mesh::Measure::facing : mesh::Measure::seen),
                  3);
}

nb::object spread_marks(const Positions& positions, const Indices& indices, const Rows<uint8_t, 3>& marks) {
  if (marks.shape(0) != indices.shape(0)) throw std::invalid_argument("marks need one row for each triangle");
  return to_numpy(mesh::spread_marks({positions.data(), positions.size()}, {indices.data(), indices.size()},
                                     {marks.data(), marks.size()}),
                  3);
}

PyMesh split_edges(const Positions& positions, const Indices& indices, const std::optional<Positions>& normals,
                   const OptionalUvs& uvs, const OptionalColors& colors, const Rows<uint8_t, 3>& marks) {
  if (marks.shape(0) != indices.shape(0)) throw std::invalid_argument("marks need one row for each triangle");
  const mesh::MeshData data = to_mesh(positions, indices, normals, uvs, colors);
  return to_python(mesh::split_edges(data, {marks.data(), marks.size()}));
}

nb::object displaced(const Positions& positions, const Indices& indices, const std::optional<Positions>& normals,
                     const OptionalUvs& uvs, const Positions& offsets, const std::string& space) {
  if (offsets.shape(0) != positions.shape(0)) throw std::invalid_argument("offsets need one row for each position");
  if (space == "tangent" && !uvs) throw std::invalid_argument("tangents need uvs");
  const mesh::MeshData data = to_mesh(positions, indices, normals, uvs, std::nullopt);
  using Space = mesh::DisplacementSpace;
  const Space kind = space == "tangent" ? Space::tangent : (space == "object" ? Space::object : Space::normal);
  return to_numpy(mesh::displaced(data, {offsets.data(), offsets.size()}, kind), 3);
}

}  // namespace

void bind_refining(nb::module_& m) {
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const mesh::BadCrease& error) {
      PyErr_SetObject(PyExc_ValueError, nb::make_tuple(error.what(), error.list()).ptr());
    }
  });
  m.def("subdivided_triangles", &subdivided_triangles, "triangles"_a, "polygons"_a.none(), "scheme"_a, "levels"_a,
        "Triangles that subdivide() makes.");
  m.def("subdivide", &subdivide, "positions"_a, "indices"_a, "polygons"_a.none(), "uvs"_a.none(), "colors"_a.none(),
        "scheme"_a, "levels"_a, "smooth_uvs"_a = true, "creases"_a.none() = nb::none(), "corners"_a.none() = nb::none(),
        "least_cosine"_a = -2.0, "The limit of a catmull_clark or loop surface, as triangles with normals.");
  nb::class_<mesh::View>(m, "View");
  m.def("lengths_in_view", &lengths_in_view, "positions"_a, "indices"_a, "view"_a, "transform"_a.none(),
        "facing"_a = false, "Lengths in pixels (M, 3) of the edges from each corner of a triangle to the next.");
  m.def("spread_marks", &spread_marks, "positions"_a, "indices"_a, "marks"_a,
        "Marks (M, 3) that have the longest edge of each triangle with a mark, and both sides of an edge.");
  m.def("split_edges", &split_edges, "positions"_a, "indices"_a, "normals"_a.none(), "uvs"_a.none(), "colors"_a.none(),
        "marks"_a, "Halves the marked edges; marks (M, 3) are equal on both sides of an edge.");
  m.def("displaced", &displaced, "positions"_a, "indices"_a, "normals"_a.none(), "uvs"_a.none(), "offsets"_a, "space"_a,
        "Positions moved by offsets (N, 3) in the space normal, object or tangent, without cracks.");
}

}  // namespace accuray::bindings
