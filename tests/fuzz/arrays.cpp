// Fuzz target: what every mesh goes through after it was read, whatever its arrays hold: repair, smooth and creased
// normals. The bytes are: which arrays there are and how many vertices, then floats as they come, then indices.
#include <cstring>
#include <vector>

#include "mesh/checks.h"
#include "mesh/normals.h"
#include "mesh_promises.h"

namespace accuray::mesh {
namespace {

class Bytes {
 public:
  Bytes(const uint8_t* data, size_t size) : next_(data), left_(size) {}

  size_t left() const { return left_; }
  uint8_t byte() {
    if (left_ == 0) return 0;
    --left_;
    return *next_++;
  }
  std::vector<float> floats(size_t count) {
    std::vector<float> values(count);
    const size_t size = std::min(count * sizeof(float), left_);
    if (size > 0) std::memcpy(values.data(), next_, size);
    next_ += size;
    left_ -= size;
    return values;
  }

 private:
  const uint8_t* next_;
  size_t left_;
};

MeshData mesh_of(Bytes& bytes) {
  const uint8_t parts = bytes.byte();
  const size_t vertices = 1 + bytes.byte() % 64;
  MeshData mesh;
  mesh.positions = bytes.floats(3 * vertices);
  if (parts & 1) mesh.normals = bytes.floats(3 * vertices);
  if (parts & 2) mesh.uvs = bytes.floats(2 * vertices);
  if (parts & 4) mesh.colors = bytes.floats(4 * vertices);
  for (size_t corners = bytes.left() / 3 * 3; corners > 0; --corners) {
    mesh.indices.push_back(static_cast<uint32_t>(bytes.byte() % vertices));
  }
  return mesh;
}

void require_creased(const MeshData& mesh, double least_cosine) {
  const CreasedMesh creased = creased_normals(mesh.positions, mesh.indices, {}, least_cosine);
  MeshData split;
  split.indices = creased.indices;
  split.normals = creased.normals;
  split.report.triangles_read = creased.indices.size() / 3;
  for (uint32_t source : creased.source) {
    for (size_t i = 0; i < 3; ++i) split.positions.push_back(mesh.positions.at(3 * size_t{source} + i));
  }
  require_promises(split);
}

}  // namespace
}  // namespace accuray::mesh

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace accuray::mesh;
  Bytes bytes(data, size);
  MeshData mesh = mesh_of(bytes);
  repair(mesh);
  require_promises(mesh);
  mesh.normals = smooth_normals(mesh.positions, mesh.indices);
  require_promises(mesh);
  require_creased(mesh, 0.5);
  require_creased(mesh, -2.0);
  return 0;
}
