#include "mesh/weld.h"

#include <bit>
#include <cstddef>

#include "mesh/index_table.h"

namespace accuray::mesh {

std::vector<uint32_t> weld(std::span<const float> positions) {
  size_t vertices = positions.size() / 3;
  std::vector<uint32_t> distinct;  // first vertex of each position
  std::vector<uint32_t> first(vertices);
  IndexTable table;
  auto bits = [&](uint32_t vertex, size_t axis) {
    return std::bit_cast<uint32_t>(positions[3 * size_t{vertex} + axis] + 0.0f);
  };
  auto hash = [&](uint32_t vertex) { return hash_words(bits(vertex, 0), bits(vertex, 1), bits(vertex, 2)); };
  for (uint32_t vertex = 0; vertex < vertices; ++vertex) {
    auto same = [&](uint32_t number) {
      uint32_t other = distinct[number];
      return bits(vertex, 0) == bits(other, 0) && bits(vertex, 1) == bits(other, 1) &&
             bits(vertex, 2) == bits(other, 2);
    };
    uint32_t fresh = static_cast<uint32_t>(distinct.size());
    uint32_t number = table.find_or_insert(hash(vertex), fresh, same, [&](uint32_t n) { return hash(distinct[n]); });
    if (number == fresh) distinct.push_back(vertex);
    first[vertex] = distinct[number];
  }
  return first;
}

}  // namespace accuray::mesh
