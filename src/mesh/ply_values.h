// The values after a PLY header, one after the other, in text or in bytes.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "mesh/error.h"
#include "mesh/input.h"
#include "mesh/ply_header.h"
#include "mesh/text.h"

namespace accuray::mesh {

// Values of an ascii file: each row of an element is one line, blank lines apart. All types fit a double exactly.
class AsciiValues {
 public:
  explicit AsciiValues(Input& input) : input_(input), words_("") {}

  // The fewest bytes that a value takes: a digit and a separator.
  static size_t least_size(PlyScalar) { return 2; }
  // Bytes left for rows to come, and for values of the row that has begun; the last value needs no separator.
  uint64_t remaining() const { return input_.remaining() + 1; }
  uint64_t remaining_in_row() const { return words_.rest().size() + 1; }

  void begin_row() {
    std::string_view line;
    do {
      if (!input_.next_line(line)) fail("the data", "", "end too early", "as many rows as the header declares");
      words_ = Words(line);
    } while (words_.at_end());
  }

  void end_row() {
    if (!words_.at_end()) fail("value", words_.peek(), "is one too many in its row", "as many as the header declares");
  }

  double next(PlyScalar) {
    double value = 0.0;
    if (words_.at_end()) fail("a row", "", "has too few values", "as many as the header declares");
    if (!words_.number(value)) fail("value", words_.peek(), "is no number", "a number such as -1.5e-3");
    return value;
  }

  bool only_blanks_left() {
    std::string_view line;
    while (input_.next_line(line)) {
      if (!Words(line).at_end()) return false;
    }
    return true;
  }

  [[noreturn]] void fail(std::string_view subject, std::string_view value, std::string_view problem,
                         std::string_view allowed) const {
    throw ReadError(input_.name(), {input_.line()}, subject, value, problem, allowed);
  }

 private:
  Input& input_;
  Words words_;
};

// Values of a binary file in the given byte order.
template <std::endian order>
class BinaryValues {
 public:
  explicit BinaryValues(Input& input) : input_(input) {}

  static size_t least_size(PlyScalar type) { return size_of(type); }
  uint64_t remaining() const { return input_.remaining(); }
  uint64_t remaining_in_row() const { return input_.remaining(); }

  void begin_row() {}
  void end_row() {}

  double next(PlyScalar type) {
    value_at_ = input_.offset();
    const char* bytes = input_.take(size_of(type));
    if (!bytes) fail("the data", "", "end too early", "as many rows as the header declares");
    switch (type) {
      case PlyScalar::int8:
        return load<int8_t, uint8_t>(bytes);
      case PlyScalar::uint8:
        return load<uint8_t, uint8_t>(bytes);
      case PlyScalar::int16:
        return load<int16_t, uint16_t>(bytes);
      case PlyScalar::uint16:
        return load<uint16_t, uint16_t>(bytes);
      case PlyScalar::int32:
        return load<int32_t, uint32_t>(bytes);
      case PlyScalar::uint32:
        return load<uint32_t, uint32_t>(bytes);
      case PlyScalar::float32:
        return load<float, uint32_t>(bytes);
      case PlyScalar::float64:
        return load<double, uint64_t>(bytes);
    }
    return 0.0;
  }

  // A line end or padding after the last row is not worth an error.
  bool only_blanks_left() {
    value_at_ = input_.offset();
    while (const char* byte = input_.take(1)) {
      if (!is_blank(*byte) && *byte != '\n' && *byte != '\0') return false;
    }
    return true;
  }

  // The place is that of the latest value.
  [[noreturn]] void fail(std::string_view subject, std::string_view value, std::string_view problem,
                         std::string_view allowed) const {
    throw ReadError(input_.name(), {0, value_at_}, subject, value, problem, allowed);
  }

 private:
  // The value of type T whose bits are the unsigned integer at `bytes`.
  template <class T, class Bits>
  static double load(const char* bytes) {
    Bits bits;
    std::memcpy(&bits, bytes, sizeof bits);
    if constexpr (order != std::endian::native) {
      if constexpr (sizeof bits == 2) bits = __builtin_bswap16(bits);
      if constexpr (sizeof bits == 4) bits = __builtin_bswap32(bits);
      if constexpr (sizeof bits == 8) bits = __builtin_bswap64(bits);
    }
    return static_cast<double>(std::bit_cast<T>(bits));
  }

  Input& input_;
  uint64_t value_at_ = 0;
};

}  // namespace accuray::mesh
