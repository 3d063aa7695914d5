// Meshes between the compiled module and numpy.
#pragma once

#include "bindings/bindings.h"
#include "mesh/mesh.h"

namespace accuray::bindings {

// A mesh as numpy arrays that own the reader's memory.
struct PyMesh {
  nb::object positions, indices, normals, uvs, colors, polygons, materials;
  nb::dict report;
  std::vector<std::string> material_names, libraries;
};

PyMesh to_python(mesh::MeshData data);

// Subdivision, splitting and displacement.
void bind_refining(nb::module_& m);

}  // namespace accuray::bindings
