// Fuzz target: the STL reader.
#include "mesh/stl.h"

#include "mesh_promises.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return accuray::mesh::fuzz_reader(accuray::mesh::read_stl_bytes, data, size);
}
