#include "mesh/stl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <utility>

#include "mesh/checks.h"
#include "mesh/error.h"
#include "mesh/index_table.h"
#include "mesh/input.h"
#include "mesh/text.h"

namespace accuray::mesh {
namespace {

constexpr size_t kHeader = 80;    // bytes of free text, before the number of triangles
constexpr size_t kTriangle = 50;  // a normal and three corners of 12 bytes each, and 2 bytes without a meaning
constexpr size_t kFirstCorner = 12;

uint32_t little_endian(const char* bytes) {
  uint32_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  if constexpr (std::endian::native != std::endian::little) bits = __builtin_bswap32(bits);
  return bits;
}

// Makes one vertex of all corners at the same position.
class Welder {
 public:
  explicit Welder(MeshData& mesh) : mesh_(mesh) {}

  // False if the vertices cannot be counted any more.
  bool add(const std::array<float, 3>& corner) {
    std::array<uint32_t, 3> key{};
    for (size_t i = 0; i < 3; ++i) key[i] = std::bit_cast<uint32_t>(corner[i] + 0.0f);  // -0 is 0
    uint32_t fresh = static_cast<uint32_t>(mesh_.positions.size() / 3);
    if (fresh == kNone) return false;
    uint32_t vertex = table_.find_or_insert(
        hash_words(key[0], key[1], key[2]), fresh, [&](uint32_t i) { return stored(i) == key; },
        [&](uint32_t i) {
          auto [a, b, c] = stored(i);
          return hash_words(a, b, c);
        });
    if (vertex == fresh) {
      for (uint32_t bits : key) mesh_.positions.push_back(std::bit_cast<float>(bits));
    }
    mesh_.indices.push_back(vertex);
    return true;
  }

 private:
  std::array<uint32_t, 3> stored(uint32_t vertex) const {
    std::array<uint32_t, 3> key{};
    for (size_t i = 0; i < 3; ++i) key[i] = std::bit_cast<uint32_t>(mesh_.positions[3 * size_t{vertex} + i]);
    return key;
  }

  MeshData& mesh_;
  IndexTable table_;
};

class StlReader {
 public:
  explicit StlReader(Input input) : input_(std::move(input)) {}

  // `start`: the first bytes of the file, up to the number of triangles.
  MeshData read(std::string_view start) {
    uint64_t size = input_.remaining();
    bool whole = start.size() == kHeader + 4;
    uint64_t declared = whole ? little_endian(start.data() + kHeader) : 0;
    bool fits = whole && size == kHeader + 4 + kTriangle * declared;
    if (fits || !start.starts_with("solid")) {
      read_binary(size, declared);
    } else {
      read_text();
    }
    repair(mesh_);
    mesh_.positions.shrink_to_fit();
    mesh_.indices.shrink_to_fit();
    return std::move(mesh_);
  }

 private:
  void read_binary(uint64_t size, uint64_t declared) {
    if (size < kHeader + 4) {
      fail({}, "the file", "", "is too short", "a header of 80 bytes and a number of triangles, or the word solid");
    }
    input_.take(kHeader + 4);
    uint64_t room = (size - kHeader - 4) / kTriangle;
    if (size != kHeader + 4 + kTriangle * declared) {
      fail({0, kHeader}, "number of triangles", std::to_string(declared), "is not that of the file's size",
           std::to_string(room) + " in " + std::to_string(size) + " bytes");
    }
    mesh_.indices.reserve(3 * declared);
    for (uint64_t i = 0; i < declared; ++i) {
      uint64_t offset = input_.offset();
      const char* bytes = input_.take(kTriangle);
      if (!bytes) fail({0, offset}, "the data", "", "end too early", "as many triangles as declared");
      for (size_t corner = 0; corner < 3; ++corner) {
        std::array<float, 3> position{};
        for (size_t axis = 0; axis < 3; ++axis) {
          position[axis] = std::bit_cast<float>(little_endian(bytes + kFirstCorner + 12 * corner + 4 * axis));
        }
        add(position, {0, offset});
      }
    }
  }

  void read_text() {
    std::string_view line;
    while (input_.next_line(line)) {
      Words words(line);
      std::string_view keyword = words.word();
      if (!keyword.empty()) read_line(keyword, words);
    }
    if (state_ != State::outside) fail_here("the file", "", "ends inside of a solid", "endsolid");
  }

  enum class State { outside, solid, facet, loop, full, closed };

  // What each state takes, and where it leads to; a loop takes vertices until it is full.
  struct Step {
    State from;
    std::string_view keyword;
    State to;
  };
  static constexpr std::array<Step, 6> kSteps = {
      {{State::outside, "solid", State::solid},
       {State::solid, "endsolid", State::outside},
       {State::solid, "facet", State::facet},  // normals follow from vertices
       {State::facet, "outer", State::loop},
       {State::full, "endloop", State::closed},
       {State::closed, "endfacet", State::solid}}};
  static constexpr std::array<std::string_view, 6> kExpected = {
      "solid", "facet normal x y z, or endsolid", "outer loop", "vertex x y z, three times", "endloop", "endfacet"};

  void read_line(std::string_view keyword, Words& words) {
    if (keyword == "vertex" && state_ == State::loop) {
      read_vertex(words);
      if (++corners_ == 3) state_ = State::full;
      return;
    }
    for (const Step& step : kSteps) {
      if (step.from != state_ || step.keyword != keyword) continue;
      state_ = step.to;
      corners_ = 0;
      return;
    }
    fail_here("the word", keyword, "is out of place", kExpected[static_cast<size_t>(state_)]);
  }

  void read_vertex(Words& words) {
    std::array<float, 3> position{};
    for (float& value : position) {
      if (words.number(value)) continue;
      if (words.at_end()) fail_here("vertex", "", "has too few numbers", "3 numbers");
      fail_here("vertex", words.peek(), "is no number", "a number such as -1.5e-3");
    }
    if (!words.at_end()) fail_here("vertex", words.peek(), "is one number too many", "3 numbers");
    add(position, {input_.line()});
  }

  void add(const std::array<float, 3>& position, Place place) {
    if (!welder_.add(position)) fail(place, "the mesh", "", "has too many vertices", "4294967294 vertices");
  }

  [[noreturn]] void fail_here(std::string_view subject, std::string_view value, std::string_view problem,
                              std::string_view allowed) const {
    fail({input_.line()}, subject, value, problem, allowed);
  }
  [[noreturn]] void fail(Place place, std::string_view subject, std::string_view value, std::string_view problem,
                         std::string_view allowed) const {
    throw ReadError(input_.name(), place, subject, value, problem, allowed);
  }

  Input input_;
  MeshData mesh_;
  Welder welder_{mesh_};
  State state_ = State::outside;
  int corners_ = 0;
};

}  // namespace

MeshData read_stl(const std::string& path) {
  Input front = Input::open(path);
  size_t size = std::min<uint64_t>(front.remaining(), kHeader + 4);
  const char* bytes = front.take(size);
  return StlReader(Input::open(path)).read({bytes, bytes ? size : 0});
}

MeshData read_stl_bytes(std::string_view bytes, const std::string& name) {
  return StlReader(Input::view(bytes, name)).read(bytes.substr(0, kHeader + 4));
}

}  // namespace accuray::mesh
