// Decimal numbers in text, independent of the locale and correctly rounded.
#pragma once

#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace accuray::mesh {

inline bool is_digit(char c) { return static_cast<unsigned char>(c - '0') < 10; }

// The common case of a short plain number, several times faster than the library (Clinger 1990): a significand below
// 2^53 and a power of ten up to 22 are exact doubles, so one operation rounds correctly. Returns the end of the number,
// or null for any other text.
template <class T>
const char* parse_short_number(const char* next, const char* end, T& value) {
  static constexpr std::array<double, 23> kPowers = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                     1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                     1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  bool negative = next != end && *next == '-';
  if (negative) ++next;
  uint64_t significand = 0;
  const char* start = next;
  for (; next != end && is_digit(*next); ++next) significand = 10 * significand + static_cast<uint64_t>(*next - '0');
  int64_t digits = next - start;
  int64_t exponent = 0;
  if (next != end && *next == '.') {
    const char* point = next++;
    for (; next != end && is_digit(*next); ++next) significand = 10 * significand + static_cast<uint64_t>(*next - '0');
    exponent = point + 1 - next;
    digits -= exponent;
  }
  if (digits == 0 || digits > 18) return nullptr;  // 18 digits cannot overflow
  if (next != end && (*next == 'e' || *next == 'E')) {
    bool plus = end - next > 2 && next[1] == '+' && is_digit(next[2]);
    int power = 0;
    auto [stop, error] = std::from_chars(next + (plus ? 2 : 1), end, power);
    if (error != std::errc{}) return nullptr;
    exponent += power;
    next = stop;
  }
  if (significand >= uint64_t{1} << 53 || exponent < -22 || exponent > 22) return nullptr;
  double power = kPowers[static_cast<size_t>(exponent < 0 ? -exponent : exponent)];
  double result = exponent < 0 ? static_cast<double>(significand) / power : static_cast<double>(significand) * power;
  if constexpr (std::is_same_v<T, float>) {
    // Rounding twice errs only where the double lies next to the middle of two floats.
    uint64_t tail = std::bit_cast<uint64_t>(result) & 0x1FFFFFFF;
    if (tail - 0x0FFFFFFF <= 2) return nullptr;
  }
  value = static_cast<T>(negative ? -result : result);
  return next;
}

// A number beyond the range of T: infinite or zero, with its sign.
template <class T>
T out_of_range_value(std::string_view text) {
  bool negative = text.front() == '-';
  if (negative) text.remove_prefix(1);
  bool small =
      text.find("e-") != text.npos || text.find("E-") != text.npos || text.front() == '0' || text.front() == '.';
  T magnitude = small ? T(0) : std::numeric_limits<T>::infinity();
  return negative ? -magnitude : magnitude;
}

// Reads a decimal number at `next`; returns its end, or null if there is none. A leading '+' is allowed. "nan", "inf"
// and what old Microsoft libraries wrote for them ("1.#QNAN") are numbers too.
template <class T>
const char* parse_number(const char* next, const char* end, T& value) {
  if (end - next > 1 && *next == '+' && next[1] != '-') ++next;
  const char* stop = parse_short_number(next, end, value);
  if (!stop) {
    auto [library_stop, error] = std::from_chars(next, end, value);
    if (error == std::errc::invalid_argument) return nullptr;
    if (error == std::errc::result_out_of_range) {
      value = out_of_range_value<T>({next, static_cast<size_t>(library_stop - next)});
    }
    stop = library_stop;
  }
  if (stop != end && *stop == '#' && stop[-1] == '.') {
    value = std::numeric_limits<T>::quiet_NaN();
    while (stop != end && *stop > ' ') ++stop;
  }
  return stop;
}

}  // namespace accuray::mesh
