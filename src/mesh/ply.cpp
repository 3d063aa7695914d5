#include "mesh/ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "mesh/checks.h"
#include "mesh/error.h"
#include "mesh/index_table.h"
#include "mesh/input.h"
#include "mesh/ply_header.h"
#include "mesh/ply_values.h"

namespace accuray::mesh {
namespace {

// Values beyond float, whose conversion would be undefined, become infinite.
float to_float(double value) {
  constexpr double largest = std::numeric_limits<float>::max();
  constexpr float infinity = std::numeric_limits<float>::infinity();
  if (value > largest) return infinity;
  if (value < -largest) return -infinity;
  return static_cast<float>(value);
}

// A whole number as it would stand in text; any other value in short form.
std::string text_of(double value) {
  std::array<char, 32> digits;
  auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}

// Where the values of a vertex go: 0 to 2 position, 3 to 5 normal, 6 and 7 uv, 8 to 11 colour and alpha.
constexpr size_t kSlots = 12;
constexpr size_t kColor = 8;
constexpr size_t kAlpha = 11;
constexpr size_t kSkip = kSlots;

template <class Values>
class PlyReader {
 public:
  PlyReader(Input& input, const PlyHeader& header, bool keep_polygons)
      : name_(input.name()), header_(header), values_(input), keep_polygons_(keep_polygons) {}

  MeshData read() {
    find_roles();
    for (const PlyElement& element : header_.elements) {
      check_size(element);
      if (&element == vertex_) {
        read_vertices();
      } else if (&element == face_) {
        read_faces();
      } else {
        skip_rows(element);
      }
    }
    if (!values_.only_blanks_left()) {
      values_.fail("the file", "", "has data after the last element", "as many rows as the header declares");
    }
    repair(mesh_);
    mesh_.indices.shrink_to_fit();
    return std::move(mesh_);
  }

 private:
  void find_roles() {
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") vertex_ = &element;
      if (element.name == "face") face_ = &element;
    }
    if (!vertex_ || !face_)
      fail_header(0, vertex_ ? "element face" : "element vertex", "is missing", "both element vertex and element face");
    if (vertex_->count >= kNone) {
      fail_header(vertex_->line, std::string("number of vertices ") + std::to_string(vertex_->count), "is too large",
                  "4294967294");
    }
    find_vertex_roles();
    find_face_roles();
    count_unused();
  }

  void find_vertex_roles() {
    slots_.assign(vertex_->properties.size(), kSkip);
    if (!claim({"x", "y", "z"}, 0))
      fail_header(vertex_->line, "element vertex", "lacks a property", "scalars x, y and z");
    has_normals_ = claim({"nx", "ny", "nz"}, 3);
    using Pair = std::array<std::string_view, 2>;
    for (const Pair& pair :
         {Pair{"u", "v"}, Pair{"s", "t"}, Pair{"texture_u", "texture_v"}, Pair{"texture_s", "texture_t"}}) {
      if (!has_uvs_) has_uvs_ = claim({pair[0], pair[1]}, 6);
    }
    find_colors();
  }

  // Red, green and blue of one type that says what their white is, and alpha if it is of that type too.
  void find_colors() {
    const std::array<std::string_view, 4> names = {"red", "green", "blue", "alpha"};
    size_t first = vertex_->find(names[0]);
    if (first == slots_.size()) return;
    PlyScalar type = vertex_->properties[first].type;
    auto fits = [&](std::string_view name) {
      size_t i = vertex_->find(name);
      return i < slots_.size() && !vertex_->properties[i].is_list && vertex_->properties[i].type == type;
    };
    const std::optional<float> white = white_of(type);
    if (!fits(names[0]) || !fits(names[1]) || !fits(names[2]) || !white) return;
    color_white_ = *white;
    mesh_.srgb_colors = is_integer(type);
    claim({names[0], names[1], names[2]}, kColor);
    if (fits(names[3])) claim({names[3]}, kAlpha);
  }

  static std::optional<float> white_of(PlyScalar type) {
    if (type == PlyScalar::uint8) return 255.0f;
    if (type == PlyScalar::uint16) return 65535.0f;
    if (is_integer(type)) return std::nullopt;
    return 1.0f;
  }

  // Sends scalar properties to consecutive slots, if all of them are there.
  bool claim(std::initializer_list<std::string_view> names, size_t slot) {
    for (std::string_view name : names) {
      size_t i = vertex_->find(name);
      if (i == slots_.size() || vertex_->properties[i].is_list) return false;
    }
    for (std::string_view name : names) slots_[vertex_->find(name)] = slot++;
    return true;
  }

  void find_face_roles() {
    corners_ = std::min(face_->find("vertex_indices"), face_->find("vertex_index"));
    if (corners_ == face_->properties.size() || !face_->properties[corners_].is_list ||
        !is_integer(face_->properties[corners_].type)) {
      fail_header(face_->line, "element face", "lacks its corners",
                  "a list of integers vertex_indices or vertex_index");
    }
  }

  void count_unused() {
    for (const PlyElement& element : header_.elements) {
      for (size_t i = 0; i < element.properties.size(); ++i) {
        bool used = &element == vertex_ ? slots_[i] != kSkip : &element == face_ && i == corners_;
        if (used || mesh_.report.unknown++ > 0) continue;
        mesh_.report.first_unknown = element.name.substr(0, 60) + " " + element.properties[i].name.substr(0, 60);
      }
    }
  }

  // The declared number of rows against the bytes that are left.
  void check_size(const PlyElement& element) const {
    uint64_t row = least_row_size(element);
    if (row == 0 || element.count <= values_.remaining() / row) return;
    fail_header(element.line, "element " + element.name + " with " + std::to_string(element.count) + " rows",
                "is larger than the file", std::to_string(values_.remaining() / row) + " rows");
  }

  uint64_t least_row_size(const PlyElement& element) const {
    uint64_t size = 0;
    for (size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      size += Values::least_size(property.is_list ? property.length_type : property.type);
      if (&element == face_ && i == corners_) size += 3 * Values::least_size(property.type);
    }
    return size;
  }

  void read_vertices() {
    mesh_.positions.reserve(3 * vertex_->count);
    if (has_normals_) mesh_.normals.reserve(3 * vertex_->count);
    if (has_uvs_) mesh_.uvs.reserve(2 * vertex_->count);
    if (has_colors()) mesh_.colors.reserve(4 * vertex_->count);
    std::array<float, kSlots + 1> row{};
    row[kAlpha] = color_white_;
    for (uint64_t i = 0; i < vertex_->count; ++i) {
      values_.begin_row();
      for (size_t j = 0; j < slots_.size(); ++j) {
        const PlyProperty& property = vertex_->properties[j];
        if (property.is_list) {
          skip_list(property);
        } else {
          row[slots_[j]] = to_float(values_.next(property.type));
        }
      }
      values_.end_row();
      mesh_.positions.insert(mesh_.positions.end(), &row[0], &row[3]);
      if (has_normals_) mesh_.normals.insert(mesh_.normals.end(), &row[3], &row[6]);
      if (has_uvs_) mesh_.uvs.insert(mesh_.uvs.end(), &row[6], &row[8]);
      if (!has_colors()) continue;
      for (size_t j = kColor; j <= kAlpha; ++j) mesh_.colors.push_back(row[j] / color_white_);
    }
  }

  bool has_colors() const { return color_white_ > 0.0f; }

  void read_faces() {
    mesh_.indices.reserve(3 * face_->count);
    for (uint64_t i = 0; i < face_->count; ++i) {
      values_.begin_row();
      for (size_t j = 0; j < face_->properties.size(); ++j) {
        if (j == corners_) {
          read_polygon(face_->properties[j]);
        } else {
          skip_value(face_->properties[j]);
        }
      }
      values_.end_row();
    }
  }

  void read_polygon(const PlyProperty& property) {
    uint64_t length = list_length(property);
    if (length < 3) values_.fail("number of corners", std::to_string(length), "is too small", "3 or more");
    if (keep_polygons_) mesh_.polygons.push_back(static_cast<uint32_t>(length));
    uint32_t first = 0, previous = 0;
    for (uint64_t i = 0; i < length; ++i) {
      double value = values_.next(property.type);
      if (!(value >= 0.0 && value < static_cast<double>(vertex_->count)) || value != std::floor(value)) {
        std::string allowed = vertex_->count == 0 ? "none, for there are no vertices"
                                                  : std::string("0 to ") + std::to_string(vertex_->count - 1);
        values_.fail("vertex index", text_of(value), "is out of range", allowed);
      }
      uint32_t vertex = static_cast<uint32_t>(value);
      if (i == 0) first = vertex;
      if (i >= 2) mesh_.indices.insert(mesh_.indices.end(), {first, previous, vertex});
      previous = vertex;
    }
  }

  uint64_t list_length(const PlyProperty& property) {
    double length = values_.next(property.length_type);
    uint64_t most = values_.remaining_in_row() / Values::least_size(property.type);
    if (!(length >= 0.0 && length <= static_cast<double>(most)) || length != std::floor(length)) {
      values_.fail("list length", text_of(length), "is out of range", std::string("0 to ") + std::to_string(most));
    }
    return static_cast<uint64_t>(length);
  }

  void skip_list(const PlyProperty& property) {
    for (uint64_t length = list_length(property); length > 0; --length) values_.next(property.type);
  }

  void skip_value(const PlyProperty& property) {
    if (property.is_list) {
      skip_list(property);
    } else {
      values_.next(property.type);
    }
  }

  // Rows without properties take no bytes, however many are declared.
  void skip_rows(const PlyElement& element) {
    if (element.properties.empty()) return;
    for (uint64_t i = 0; i < element.count; ++i) {
      values_.begin_row();
      for (const PlyProperty& property : element.properties) skip_value(property);
      values_.end_row();
    }
  }

  [[noreturn]] void fail_header(uint64_t line, std::string_view subject, std::string_view problem,
                                std::string_view allowed) const {
    throw ReadError(name_, {line}, subject, "", problem, allowed);
  }

  std::string name_;
  const PlyHeader& header_;
  Values values_;
  bool keep_polygons_;
  const PlyElement* vertex_ = nullptr;
  const PlyElement* face_ = nullptr;
  std::vector<size_t> slots_;  // per property of a vertex
  bool has_normals_ = false;
  bool has_uvs_ = false;
  float color_white_ = 0.0f;  // what white is stored as; 0: no colours
  size_t corners_ = 0;        // position of the list of corners in the properties of a face
  MeshData mesh_;
};

MeshData read(Input input, bool keep_polygons) {
  PlyHeader header = read_ply_header(input);
  switch (header.format) {
    case PlyFormat::binary_little_endian:
      return PlyReader<BinaryValues<std::endian::little>>(input, header, keep_polygons).read();
    case PlyFormat::binary_big_endian:
      return PlyReader<BinaryValues<std::endian::big>>(input, header, keep_polygons).read();
    case PlyFormat::ascii:
      break;
  }
  return PlyReader<AsciiValues>(input, header, keep_polygons).read();
}

}  // namespace

MeshData read_ply(const std::string& path, bool keep_polygons) { return read(Input::open(path), keep_polygons); }

MeshData read_ply_bytes(std::string_view bytes, const std::string& name, bool keep_polygons) {
  return read(Input::view(bytes, name), keep_polygons);
}

}  // namespace accuray::mesh
