// Fuzz target: the OBJ reader.
#include "mesh/obj.h"

#include "mesh_promises.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return accuray::mesh::fuzz_reader(accuray::mesh::read_obj_text, data, size);
}
