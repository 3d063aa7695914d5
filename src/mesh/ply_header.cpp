#include "mesh/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <optional>
#include <utility>

#include "mesh/error.h"
#include "mesh/text.h"

namespace accuray::mesh {
namespace {

constexpr size_t kMaxHeaderLines = 100000;

constexpr std::array<std::pair<std::string_view, PlyScalar>, 16> kScalarNames = {{
    {"char", PlyScalar::int8},
    {"int8", PlyScalar::int8},
    {"uchar", PlyScalar::uint8},
    {"uint8", PlyScalar::uint8},
    {"short", PlyScalar::int16},
    {"int16", PlyScalar::int16},
    {"ushort", PlyScalar::uint16},
    {"uint16", PlyScalar::uint16},
    {"int", PlyScalar::int32},
    {"int32", PlyScalar::int32},
    {"uint", PlyScalar::uint32},
    {"uint32", PlyScalar::uint32},
    {"float", PlyScalar::float32},
    {"float32", PlyScalar::float32},
    {"double", PlyScalar::float64},
    {"float64", PlyScalar::float64},
}};

constexpr std::array<std::pair<std::string_view, PlyFormat>, 3> kFormatNames = {{
    {"ascii", PlyFormat::ascii},
    {"binary_little_endian", PlyFormat::binary_little_endian},
    {"binary_big_endian", PlyFormat::binary_big_endian},
}};

template <class Table>
auto look_up(const Table& table, std::string_view name) -> std::optional<decltype(table[0].second)> {
  for (const auto& [known, value] : table) {
    if (known == name) return value;
  }
  return std::nullopt;
}

class HeaderReader {
 public:
  explicit HeaderReader(Input& input) : input_(input) {}

  PlyHeader read() {
    if (next() != "ply") fail("the first line", line_, "is wrong", "ply");
    read_format();
    while (input_.line() < kMaxHeaderLines) {
      Words words(next());
      std::string_view keyword = words.word();
      if (keyword == "end_header") return std::move(header_);
      if (keyword == "element") {
        read_element(words);
      } else if (keyword == "property") {
        read_property(words);
      } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
        fail("header keyword", keyword, "is unknown", "comment, obj_info, element, property or end_header");
      }
    }
    fail("the header", "", "is too long", std::to_string(kMaxHeaderLines) + " lines");
  }

 private:
  std::string_view next() {
    if (!input_.next_line(line_)) fail("the header", "", "ends too early", "a header that ends with end_header");
    return line_;
  }

  void read_format() {
    std::string_view keyword;
    Words words("");
    do {
      words = Words(next());
      keyword = words.word();
    } while (keyword == "comment" || keyword == "obj_info");
    std::string_view name = words.word(), version = words.word();
    auto format = look_up(kFormatNames, name);
    if (keyword != "format" || !format || version != "1.0" || !words.at_end()) {
      fail("format line", line_, "is wrong",
           "format ascii 1.0, format binary_little_endian 1.0 or format binary_big_endian 1.0");
    }
    header_.format = *format;
  }

  void read_element(Words& words) {
    std::string_view name = words.word(), count_text = words.word();
    PlyElement element{std::string(name), 0, input_.line()};
    const char* end = std::to_address(count_text.end());
    auto [stop, error] = std::from_chars(std::to_address(count_text.begin()), end, element.count);
    if (count_text.empty() || stop != end || error != std::errc{} || !words.at_end()) {
      fail("element line", line_, "is wrong", "element NAME COUNT");
    }
    for (const PlyElement& other : header_.elements) {
      if (other.name == name) fail("element", name, "is declared twice", "one of each name");
    }
    header_.elements.push_back(std::move(element));
  }

  void read_property(Words& words) {
    if (header_.elements.empty()) fail("property line", line_, "comes too early", "an element before it");
    PlyProperty property;
    std::string_view type = words.word();
    property.is_list = type == "list";
    if (property.is_list) {
      property.length_type = scalar(words.word());
      if (!is_integer(property.length_type)) fail("list length in", line_, "is no integer", "an integer type");
      type = words.word();
    }
    property.type = scalar(type);
    property.name = words.word();
    if (property.name.empty() || !words.at_end()) {
      fail("property line", line_, "is wrong", "property TYPE NAME or property list TYPE TYPE NAME");
    }
    PlyElement& element = header_.elements.back();
    if (element.find(property.name) < element.properties.size()) {
      fail("property", property.name, "is declared twice", "one of each name in an element");
    }
    element.properties.push_back(std::move(property));
  }

  PlyScalar scalar(std::string_view name) const {
    auto type = look_up(kScalarNames, name);
    if (!type) {
      fail("type", name, "is unknown",
           "char, uchar, short, ushort, int, uint, float, double, int8, uint8, ..., float64");
    }
    return *type;
  }

  [[noreturn]] void fail(std::string_view subject, std::string_view value, std::string_view problem,
                         std::string_view allowed) const {
    throw ReadError(input_.name(), {std::max<uint64_t>(input_.line(), 1)}, subject, value, problem, allowed);
  }

  Input& input_;
  std::string_view line_;
  PlyHeader header_;
};

}  // namespace

size_t PlyElement::find(std::string_view property) const {
  size_t i = 0;
  while (i < properties.size() && properties[i].name != property) ++i;
  return i;
}

PlyHeader read_ply_header(Input& input) { return HeaderReader(input).read(); }

}  // namespace accuray::mesh
