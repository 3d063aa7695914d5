// Fuzz target: the PLY reader.
#include "mesh/ply.h"

#include "mesh_promises.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return accuray::mesh::fuzz_reader(accuray::mesh::read_ply_bytes, data, size);
}
