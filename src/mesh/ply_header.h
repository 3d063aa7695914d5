// The header of a PLY file: which elements follow, of which properties, in which encoding.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesh/input.h"

namespace accuray::mesh {

enum class PlyFormat { ascii, binary_little_endian, binary_big_endian };

enum class PlyScalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr size_t size_of(PlyScalar type) {
  constexpr size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<size_t>(type)];
}

constexpr bool is_integer(PlyScalar type) { return type < PlyScalar::float32; }

struct PlyProperty {
  std::string name;
  PlyScalar type;  // of the value, or of each item of a list
  bool is_list = false;
  PlyScalar length_type = PlyScalar::uint8;  // of a list's length
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;
  uint64_t line = 0;  // of its declaration
  std::vector<PlyProperty> properties{};

  // Position of a property, or properties.size() if there is none of that name.
  size_t find(std::string_view property) const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements{};
};

// Reads up to and including the line "end_header"; throws ReadError for anything that PLY 1.0 does not allow. The
// counts are as declared: nothing has been allocated or checked for them.
PlyHeader read_ply_header(Input& input);

}  // namespace accuray::mesh
