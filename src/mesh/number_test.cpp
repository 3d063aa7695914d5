#include "mesh/number.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <string>

namespace accuray::mesh {
namespace {

template <class T>
T parsed(const std::string& text) {
  T value = T(-12345);
  const char* end = parse_number(text.data(), text.data() + text.size(), value);
  EXPECT_EQ(end, text.data() + text.size()) << text;
  return value;
}

// The library is the oracle, which rounds correctly.
template <class T>
void expect_as_library(const std::string& text) {
  T expected{};
  auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), expected);
  ASSERT_EQ(error, std::errc{}) << text;
  ASSERT_EQ(end, text.data() + text.size()) << text;
  ASSERT_EQ(parsed<T>(text), expected) << text;
}

TEST(Number, RoundsAsTheLibrary) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 200000; ++i) {
    int digits = 1 + static_cast<int>(random() % 19);
    std::string text = random() % 2 ? "-" : "";
    size_t point = random() % static_cast<size_t>(digits + 1);
    for (int j = 0; j < digits; ++j) {
      if (static_cast<size_t>(j) == point && j > 0) text += '.';
      text += static_cast<char>('0' + random() % 10);
    }
    if (random() % 2) text.append("e").append(std::to_string(static_cast<int>(random() % 30) - 15));
    expect_as_library<float>(text);
    expect_as_library<double>(text);
  }
}

// Decimals in the middle of two floats, and next to it, are where rounding twice would err.
TEST(Number, HalfwayCases) {
  std::mt19937 random(11);
  for (int i = 0; i < 20000; ++i) {
    float low = std::ldexp(static_cast<float>(0x800000 + random() % 0x800000), static_cast<int>(random() % 20) - 33);
    double middle = (double{low} + double{std::nextafter(low, HUGE_VALF)}) / 2;
    char text[64];
    for (const char* format : {"%.16g", "%.17g", "%.18g", "%.15g"}) {
      std::snprintf(text, sizeof text, format, middle);
      expect_as_library<float>(text);
    }
  }
}

TEST(Number, SpecialForms) {
  EXPECT_EQ(parsed<float>("+2.5"), 2.5f);
  EXPECT_EQ(parsed<float>("5."), 5.0f);
  EXPECT_EQ(parsed<float>(".5"), 0.5f);
  EXPECT_EQ(parsed<float>("1e+3"), 1000.0f);
  EXPECT_TRUE(std::signbit(parsed<float>("-0")));
  EXPECT_EQ(parsed<float>("1e39"), HUGE_VALF);
  EXPECT_EQ(parsed<float>("-1e400"), -HUGE_VALF);
  EXPECT_EQ(parsed<float>("1e-60"), 0.0f);
  EXPECT_EQ(parsed<double>("1e-400"), 0.0);
  EXPECT_EQ(parsed<float>("-inf"), -HUGE_VALF);
  EXPECT_TRUE(std::isnan(parsed<float>("nan")));
  EXPECT_TRUE(std::isnan(parsed<float>("1.#QNAN")));
  EXPECT_TRUE(std::isnan(parsed<float>("-1.#IND00")));
}

TEST(Number, NotNumbers) {
  for (const std::string text : {"", "-", "+", "+-1", "++1", ".", "e5", "x", "-x", "#"}) {
    float value = 0.0f;
    EXPECT_EQ(parse_number(text.data(), text.data() + text.size(), value), nullptr) << text;
  }
  // The end tells what was read.
  const std::string text = "1e5x";
  float value = 0.0f;
  EXPECT_EQ(parse_number(text.data(), text.data() + text.size(), value), text.data() + 3);
}

}  // namespace
}  // namespace accuray::mesh
