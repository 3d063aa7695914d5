// Which vertices of a mesh lie at the same place.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace accuray::mesh {

// For each vertex the first one at exactly the same position (3 floats each; 0 and -0 are the same).
std::vector<uint32_t> weld(std::span<const float> positions);

}  // namespace accuray::mesh
