// The exception of all mesh readers.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace accuray::mesh {

// A place in a file: a line, counted from 1, in text; a byte, counted from 0, in binary data, where line is 0. The
// default stands for the file as a whole.
struct Place {
  static constexpr uint64_t kNowhere = ~uint64_t{0};
  uint64_t line = 0;
  uint64_t byte = kNowhere;
};

// What is wrong with a mesh file, where, and what would have been right. As text, for instance:
//   cube.obj:12: position index '9' is out of range: allowed 1 to 8 or -8 to -1
class ReadError : public std::runtime_error {
 public:
  // subject: what the value is ("position index"); value: the offending text, quoted as it stands in the file;
  // problem: what is wrong with it ("is out of range"); allowed: what would be right.
  ReadError(std::string_view file, Place place, std::string_view subject, std::string_view value,
            std::string_view problem, std::string_view allowed);

  const std::string& file() const { return file_; }
  const Place& place() const { return place_; }
  const std::string& value() const { return value_; }
  const std::string& allowed() const { return allowed_; }

 private:
  std::string file_;
  Place place_;
  std::string value_;
  std::string allowed_;
};

}  // namespace accuray::mesh
