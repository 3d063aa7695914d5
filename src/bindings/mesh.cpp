// The mesh readers.
#include "mesh/mesh.h"

#include "bindings/py_mesh.h"
#include "lower/srgb.h"
#include "mesh/checks.h"
#include "mesh/error.h"
#include "mesh/normals.h"
#include "mesh/obj.h"
#include "mesh/ply.h"
#include "mesh/stl.h"

namespace accuray::bindings {

namespace {

nb::dict describe(const mesh::MeshReport& report) {
  nb::dict d;
  d["triangles_read"] = report.triangles_read;
  d["nonfinite_triangles"] = report.nonfinite_triangles;
  d["degenerate_triangles"] = report.degenerate_triangles;
  d["nonfinite_vertices"] = report.nonfinite_vertices;
  d["generated_normals"] = report.generated_normals;
  d["missing_uvs"] = report.missing_uvs;
  d["missing_colors"] = report.missing_colors;
  d["unknown"] = report.unknown;
  d["first_unknown"] = report.first_unknown;
  return d;
}

}  // namespace

PyMesh to_python(mesh::MeshData data) {
  PyMesh result{to_numpy(std::move(data.positions), 3),
                to_numpy(std::move(data.indices), 3),
                nb::none(),
                nb::none(),
                nb::none(),
                nb::none(),
                nb::none(),
                describe(data.report),
                std::move(data.material_names),
                std::move(data.libraries)};
  if (!data.normals.empty()) result.normals = to_numpy(std::move(data.normals), 3);
  if (!data.uvs.empty()) result.uvs = to_numpy(std::move(data.uvs), 2);
  if (!data.colors.empty()) result.colors = to_numpy(std::move(data.colors), 4);
  if (!data.polygons.empty()) result.polygons = to_numpy(std::move(data.polygons), 0);
  if (!data.materials.empty()) result.materials = to_numpy(std::move(data.materials), 0);
  return result;
}

namespace {

// Alpha stays as it is.
void undo_srgb(std::vector<float>& colors) {
  for (size_t i = 0; i < colors.size(); ++i) {
    if (i % 4 != 3) colors[i] = static_cast<float>(from_srgb(static_cast<double>(colors[i])));
  }
}

template <class Read>
PyMesh read(Read read_file) {
  mesh::MeshData data;
  {
    const nb::gil_scoped_release release;
    data = read_file();
    if (data.srgb_colors) undo_srgb(data.colors);
  }
  return to_python(std::move(data));
}

PyMesh repair(const Rows<float, 3>& positions, const Rows<uint32_t, 3>& indices,
              const std::optional<Rows<float, 3>>& normals, const std::optional<Rows<float, 2>>& uvs,
              const std::optional<Rows<float, 4>>& colors) {
  mesh::MeshData data;
  data.positions = to_vector(positions);
  data.indices = to_vector(indices);
  if (normals) data.normals = to_vector(*normals);
  if (uvs) data.uvs = to_vector(*uvs);
  if (colors) data.colors = to_vector(*colors);
  mesh::require_indices_in_range(data, "<arrays>");
  {
    const nb::gil_scoped_release release;
    mesh::repair(data);
  }
  return to_python(std::move(data));
}

nb::object smooth_normals(const Rows<float, 3>& positions, const Rows<uint32_t, 3>& indices) {
  return to_numpy(mesh::smooth_normals({positions.data(), positions.size()}, {indices.data(), indices.size()}), 3);
}

nb::tuple creased_normals(const Rows<float, 3>& positions, const Rows<uint32_t, 3>& indices, double least_cosine) {
  mesh::CreasedMesh creased =
      mesh::creased_normals({positions.data(), positions.size()}, {indices.data(), indices.size()}, {}, least_cosine);
  return nb::make_tuple(to_numpy(std::move(creased.source), 0), to_numpy(std::move(creased.indices), 3),
                        to_numpy(std::move(creased.normals), 3));
}

}  // namespace

void bind_mesh(nb::module_& module) {
  nb::module_ m = module.def_submodule("mesh", "Mesh readers and repairs.");
  nb::exception<mesh::ReadError>(m, "ReadError", PyExc_ValueError);
  nb::class_<PyMesh>(m, "Mesh")
      .def_ro("positions", &PyMesh::positions)
      .def_ro("indices", &PyMesh::indices)
      .def_ro("normals", &PyMesh::normals)
      .def_ro("uvs", &PyMesh::uvs)
      .def_ro("colors", &PyMesh::colors, "Linear red, green, blue and alpha.")
      .def_ro("polygons", &PyMesh::polygons, "Corners of each polygon, whose fans the indices are.")
      .def_ro("materials", &PyMesh::materials, "Index into material_names of each triangle.")
      .def_ro("material_names", &PyMesh::material_names)
      .def_ro("libraries", &PyMesh::libraries, "What an OBJ file says after mtllib.")
      .def_ro("report", &PyMesh::report);
  m.def(
      "read_obj",
      [](const std::string& path, bool polygons) { return read([&] { return mesh::read_obj(path, polygons); }); },
      "path"_a, "polygons"_a = false, "Reads a Wavefront OBJ file; with its polygons, as a control mesh.");
  m.def(
      "read_ply",
      [](const std::string& path, bool polygons) { return read([&] { return mesh::read_ply(path, polygons); }); },
      "path"_a, "polygons"_a = false, "Reads a PLY file; with its polygons, as a control mesh.");
  m.def(
      "read_stl", [](const std::string& path) { return read([&] { return mesh::read_stl(path); }); }, "path"_a,
      "Reads an STL file.");
  m.def("repair", &repair, "positions"_a, "indices"_a, "normals"_a.none(), "uvs"_a.none(), "colors"_a.none(),
        "Drops and counts what cannot be rendered.");
  m.def("smooth_normals", &smooth_normals, "positions"_a, "indices"_a, "One unit normal per vertex.");
  m.def("creased_normals", &creased_normals, "positions"_a, "indices"_a, "least_cosine"_a,
        "Old vertex of each new one, indices and normals, smooth except across edges.");
  bind_refining(m);
}

}  // namespace accuray::bindings
