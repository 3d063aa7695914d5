// Fuzz target: the PLY reader, once for triangles and once for polygons.
#include "mesh/ply.h"

#include "mesh_promises.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace accuray::mesh;
  for (bool polygons : {false, true}) {
    fuzz_reader([=](auto bytes, const auto& name) { return read_ply_bytes(bytes, name, polygons); }, data, size);
  }
  return 0;
}
