#include "mesh/obj.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <system_error>
#include <unordered_map>
#include <utility>

#include "mesh/checks.h"
#include "mesh/error.h"
#include "mesh/index_table.h"
#include "mesh/input.h"
#include "mesh/normals.h"
#include "mesh/text.h"

namespace accuray::mesh {
namespace {

// What a corner of a face refers to, counted from 0; kNone where it has no such part.
struct Corner {
  uint32_t position, uv, normal;
  bool operator==(const Corner&) const = default;
};

// One of the three lists that faces refer to.
struct Attribute {
  const char* name;
  size_t width;
  std::vector<float> values{};
  // The farthest reference to an entry that did not exist yet, and its line.
  uint64_t farthest = 0;
  uint64_t farthest_line = 0;

  uint64_t count() const { return values.size() / width; }
  // What a face may write at this point; `relative`: also back from the latest.
  std::string allowed(bool relative) const {
    if (values.empty()) return std::string("none, for there is no ") + name;
    std::string last = std::to_string(count());
    return "1 to " + last + (relative ? " or -" + last + " to -1" : "");
  }
};

class ObjReader {
 public:
  ObjReader(Input input, bool keep_polygons) : input_(std::move(input)), keep_polygons_(keep_polygons) {}

  MeshData read() {
    std::string_view line;
    while (next_logical_line(line)) read_line(line);
    check_references();
    gather();
    repair(mesh_);
    smooth();
    mesh_.indices.shrink_to_fit();
    return std::move(mesh_);
  }

 private:
  // Smoothing groups make the normals of a file that has none.
  void smooth() {
    if (mesh_.smoothing_groups.empty() || !mesh_.normals.empty() || keep_polygons_) return;
    CreasedMesh creased = creased_normals(mesh_.positions, mesh_.indices, mesh_.smoothing_groups, -2.0);
    mesh_.report.generated_normals += creased.source.size();
    take(mesh_.positions, 3, creased.source);
    take(mesh_.uvs, 2, creased.source);
    take(mesh_.colors, 4, creased.source);
    mesh_.indices = std::move(creased.indices);
    mesh_.normals = std::move(creased.normals);
  }

  // The rows of a list, `width` wide, that `source` names.
  static void take(std::vector<float>& values, size_t width, const std::vector<uint32_t>& source) {
    if (values.empty()) return;
    std::vector<float> taken;
    taken.reserve(source.size() * width);
    for (uint32_t row : source) {
      for (size_t i = 0; i < width; ++i) taken.push_back(values[row * width + i]);
    }
    values = std::move(taken);
  }

  // Whether a line goes on in the next. Comments do not: many name a Windows folder at their end.
  static bool continues(std::string_view line) { return line.ends_with('\\') && line.find('#') == line.npos; }

  // The next line with its continuations; first_line_ becomes the number of its first one.
  bool next_logical_line(std::string_view& line) {
    if (!input_.next_line(line)) return false;
    first_line_ = input_.line();
    if (!continues(line)) return true;
    joined_.clear();
    while (continues(line)) {
      joined_.append(line.substr(0, line.size() - 1)).push_back(' ');
      check_length(joined_.size());
      if (!input_.next_line(line)) line = {};
    }
    line = joined_.append(line);
    return true;
  }

  void check_length(size_t size) const {
    if (size > Input::kMaxLine) fail("a continued line", "", "is too long", std::to_string(Input::kMaxLine) + " bytes");
  }

  void read_line(std::string_view line) {
    if (line.starts_with("\xEF\xBB\xBF") && first_line_ == 1) line.remove_prefix(3);  // byte order mark
    Words words(line, true);
    std::string_view keyword = words.word();
    if (keyword.empty()) return;
    if (keyword == "v") {
      read_position(words);
    } else if (keyword == "vn") {
      read_numbers(words, keyword, 3, 3, normals_);
    } else if (keyword == "vt") {
      read_numbers(words, keyword, 1, 3, uvs_);
    } else if (keyword == "f") {
      read_face(words);
    } else if (keyword == "usemtl") {
      use_material(rest_of(words));
    } else if (keyword == "mtllib") {
      mesh_.libraries.emplace_back(rest_of(words));
    } else if (keyword == "s") {
      read_smoothing_group(words);
    } else if (std::find(kIgnored.begin(), kIgnored.end(), keyword) == kIgnored.end()) {
      if (mesh_.report.unknown++ == 0) {
        mesh_.report.first_unknown = std::string(keyword.substr(0, 60)) + " in line " + std::to_string(first_line_);
      }
      return;
    }
    recognised_ = true;
  }

  void read_position(Words& words) {
    std::array<float, 6> value{};
    size_t count = read_numbers(words, "v", 3, 6, positions_, value);
    if (count == 5) fail("v", "", "has 5 numbers", "3, 4 or 6 numbers");
    if (count == 6 || !colors_.empty()) add_color(count == 6 ? &value[3] : nullptr);
  }

  // The colour of the latest position, null if it has none; those before the first colour have none.
  void add_color(const float* color) {
    colors_.resize(3 * (positions_.count() - 1), std::numeric_limits<float>::quiet_NaN());
    for (size_t i = 0; i < 3; ++i) colors_.push_back(color ? color[i] : std::numeric_limits<float>::quiet_NaN());
  }

  void read_numbers(Words& words, std::string_view keyword, size_t low, size_t high, Attribute& attribute) {
    std::array<float, 6> value{};
    read_numbers(words, keyword, low, high, attribute, value);
  }
  // Appends the first `attribute.width` of `low` to `high` numbers (0 where there are fewer); returns how many.
  size_t read_numbers(Words& words, std::string_view keyword, size_t low, size_t high, Attribute& attribute,
                      std::array<float, 6>& value) {
    size_t count = 0;
    while (count < high && !words.at_end()) {
      if (!words.number(value[count])) fail(keyword, words.peek(), "is no number", "a number such as -1.5e-3");
      ++count;
    }
    if (count < low || !words.at_end()) {
      std::string allowed = low == high ? std::to_string(low) : std::to_string(low) + " to " + std::to_string(high);
      if (count < low)
        fail(keyword, "", std::string("has ") + std::to_string(count) + " numbers", allowed + " numbers");
      fail(keyword, words.peek(), "is one number too many", allowed + " numbers");
    }
    attribute.values.insert(attribute.values.end(), value.begin(),
                            value.begin() + static_cast<ptrdiff_t>(attribute.width));
    return count;
  }

  void read_face(Words& words) {
    uint32_t first = 0, previous = 0;
    size_t count = 0;
    for (; !words.at_end(); ++count) {
      uint32_t vertex = vertex_of(read_corner(words));
      if (count >= 2) mesh_.indices.insert(mesh_.indices.end(), {first, previous, vertex});
      if (count == 0) first = vertex;
      previous = vertex;
    }
    if (count < 3) fail("f", "", std::string("has ") + std::to_string(count) + " corners", "3 or more corners");
    if (keep_polygons_) mesh_.polygons.push_back(static_cast<uint32_t>(count));
    mark_triangles();
  }

  // Gives the latest triangles the material and the smoothing group that hold now. The lists begin with the first one
  // that has any.
  void mark_triangles() {
    size_t triangles = mesh_.indices.size() / 3;
    if (material_ != kNone) mesh_.materials.resize(triangles, material_);
    if (smoothing_group_ != 0) any_smoothing_ = true;
    if (any_smoothing_) mesh_.smoothing_groups.resize(triangles, smoothing_group_);
  }

  // The rest of a line without the blanks at its ends and without a comment: names of materials have blanks in them.
  static std::string_view rest_of(Words& words) {
    if (words.at_end()) return {};
    std::string_view text = words.rest();
    text = text.substr(0, text.find(" #"));
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
  }

  void use_material(std::string_view name) {
    if (name.size() > kMaxName) fail("material name", name, "is too long", std::to_string(kMaxName) + " bytes");
    // Faces before the first name have none.
    if (material_ == kNone && !mesh_.indices.empty()) {
      mesh_.material_names.emplace_back();
      numbers_.emplace("", 0);
      mesh_.materials.assign(mesh_.indices.size() / 3, 0);
    }
    auto [place, fresh] = numbers_.try_emplace(std::string(name), static_cast<uint32_t>(mesh_.material_names.size()));
    if (fresh) mesh_.material_names.emplace_back(name);
    material_ = place->second;
  }

  void read_smoothing_group(Words& words) {
    std::string_view text = words.word();
    if (text.empty() || text == "off") {
      smoothing_group_ = 0;
    } else if (text == "on") {
      smoothing_group_ = 1;
    } else {
      auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), smoothing_group_);
      if (error != std::errc{} || end != text.data() + text.size()) {
        fail("smoothing group", text, "is no number", "a whole number from 0 to 4294967295, or off");
      }
    }
  }

  // v, v/t, v//n or v/t/n; a part may be left empty except the first.
  Corner read_corner(Words& words) {
    std::string_view text = words.rest();
    const char *next = text.data(), *end = next + text.size();
    Corner corner{kNone, kNone, kNone};
    bool good = read_index(next, end, positions_, corner.position);
    if (good && next != end && *next == '/') {
      ++next;
      if (next != end && !is_blank(*next) && *next != '/') good = read_index(next, end, uvs_, corner.uv);
      if (good && next != end && *next == '/') {
        ++next;
        if (next != end && !is_blank(*next)) good = read_index(next, end, normals_, corner.normal);
      }
    }
    if (!good || (next != end && !is_blank(*next))) {
      fail("face corner", words.peek(), "is malformed", "v, v/t, v//n or v/t/n");
    }
    words.skip(static_cast<size_t>(next - text.data()));
    return corner;
  }

  // Reads one index and counts it from 0; false if there is none.
  bool read_index(const char*& next, const char* end, Attribute& attribute, uint32_t& result) {
    const char* start = next;
    bool negative = *next == '-';
    next += negative ? 1 : 0;
    uint64_t index = 0;
    const char* digits = next;
    for (; next != end && is_digit(*next); ++next) {
      if (index <= kNone) index = 10 * index + static_cast<uint64_t>(*next - '0');
    }
    if (next == digits) return false;
    uint64_t count = attribute.count();
    if (index == 0 || index >= (negative ? count + 1 : kNone)) {
      std::string subject = std::string(attribute.name) + " index";
      fail(subject, {start, static_cast<size_t>(next - start)}, "is out of range", attribute.allowed(true));
    }
    if (!negative && index > count && index > attribute.farthest) {
      attribute.farthest = index;
      attribute.farthest_line = first_line_;
    }
    result = static_cast<uint32_t>(negative ? count - index : index - 1);
    return true;
  }

  // The vertex of a corner, new or met before. Most often it is the latest one at its position: faces around a position
  // are close together in a file, and so is this list in memory, whereas the hash table is a cache miss each time.
  uint32_t vertex_of(const Corner& corner) {
    uint64_t positions = positions_.count();
    if (corner.position >= positions) return find_vertex(corner);
    if (latest_.size() < positions) latest_.resize(positions, kNone);
    uint32_t& latest = latest_[corner.position];
    if (latest == kNone || corners_[latest] != corner) latest = find_vertex(corner);
    return latest;
  }

  uint32_t find_vertex(const Corner& corner) {
    auto hash = [](const Corner& c) { return hash_words(c.position, c.uv, c.normal); };
    uint32_t fresh = static_cast<uint32_t>(corners_.size());
    if (fresh == kNone) fail("the mesh", "", "has too many vertices", "4294967294 vertices");
    uint32_t vertex = table_.find_or_insert(
        hash(corner), fresh, [&](uint32_t i) { return corners_[i] == corner; },
        [&](uint32_t i) { return hash(corners_[i]); });
    if (vertex == fresh) corners_.push_back(corner);
    return vertex;
  }

  // References to later lines can be judged only when all lines are read.
  void check_references() {
    if (!recognised_ && mesh_.report.unknown > 0) {
      first_line_ = 1;
      fail("this", "", "is no OBJ file: no line has a known keyword", "v, vt, vn, f, ...");
    }
    for (const Attribute* attribute : {&positions_, &uvs_, &normals_}) {
      if (attribute->farthest <= attribute->count()) continue;
      first_line_ = attribute->farthest_line;
      fail(std::string(attribute->name) + " index", std::to_string(attribute->farthest), "is out of range",
           attribute->allowed(false));
    }
  }

  // Makes the vertices out of the corners. The lists are freed as soon as they are used, to keep the peak low.
  void gather() {
    table_ = {};
    latest_ = {};
    gather_colors();
    mesh_.positions = gather(positions_, &Corner::position, 0.0f);
    mesh_.normals = gather(normals_, &Corner::normal, std::numeric_limits<float>::quiet_NaN());
    mesh_.uvs = gather(uvs_, &Corner::uv, std::numeric_limits<float>::quiet_NaN());
    corners_ = {};
  }

  void gather_colors() {
    if (colors_.empty()) return;
    mesh_.srgb_colors = true;
    mesh_.colors.reserve(4 * corners_.size());
    for (const Corner& corner : corners_) {
      const float* color = &colors_[3 * size_t{corner.position}];
      mesh_.colors.insert(mesh_.colors.end(), {color[0], color[1], color[2], 1.0f});
    }
    colors_ = {};
  }

  // The values of one list per vertex, `missing` where a corner has none; empty if no corner has any.
  std::vector<float> gather(Attribute& attribute, uint32_t Corner::* index, float missing) {
    std::vector<float> result;
    bool used = std::any_of(corners_.begin(), corners_.end(), [&](const Corner& c) { return c.*index != kNone; });
    if (used) {
      result.reserve(corners_.size() * attribute.width);
      for (const Corner& corner : corners_) {
        for (size_t i = 0; i < attribute.width; ++i) {
          result.push_back(corner.*index == kNone ? missing : attribute.values[corner.*index * attribute.width + i]);
        }
      }
    }
    attribute.values = {};
    return result;
  }

  [[noreturn]] void fail(std::string_view subject, std::string_view value, std::string_view problem,
                         std::string_view allowed) const {
    throw ReadError(input_.name(), {first_line_}, subject, value, problem, allowed);
  }

  static constexpr std::array<std::string_view, 4> kIgnored = {"g", "o", "p", "l"};
  static constexpr size_t kMaxName = 200;

  Input input_;
  bool keep_polygons_;
  uint64_t first_line_ = 0;
  std::string joined_;
  bool recognised_ = false;
  Attribute positions_{"position", 3};
  Attribute uvs_{"uv", 2};
  Attribute normals_{"normal", 3};
  std::vector<float> colors_;    // 3 per position; empty before the first one that has a colour
  std::vector<Corner> corners_;  // the distinct ones: corner i becomes vertex i
  IndexTable table_;
  uint32_t material_ = kNone;     // of the faces to come; kNone before the first usemtl
  uint32_t smoothing_group_ = 0;  // likewise
  bool any_smoothing_ = false;
  std::unordered_map<std::string, uint32_t> numbers_;  // of the materials
  std::vector<uint32_t> latest_;                       // per position, the vertex it was used as last; kNone if unused
  MeshData mesh_;
};

}  // namespace

MeshData read_obj(const std::string& path, bool keep_polygons) {
  return ObjReader(Input::open(path), keep_polygons).read();
}

MeshData read_obj_text(std::string_view text, const std::string& name, bool keep_polygons) {
  return ObjReader(Input::view(text, name), keep_polygons).read();
}

}  // namespace accuray::mesh
