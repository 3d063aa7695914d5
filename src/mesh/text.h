// The words of a line of text.
#pragma once

#include <string_view>

#include "mesh/number.h"

namespace accuray::mesh {

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

// Reads the words of one line, front to back. A '#' at the start of a word begins a comment if `comments` is set.
class Words {
 public:
  explicit Words(std::string_view line, bool comments = false)
      : next_(line.data()), end_(line.data() + line.size()), comments_(comments) {}

  // Whether nothing but blanks and a comment is left.
  bool at_end() {
    while (next_ != end_ && is_blank(*next_)) ++next_;
    return next_ == end_ || (comments_ && *next_ == '#');
  }

  // The next word, empty at the end; peek() leaves it to be read again.
  std::string_view peek() {
    if (at_end()) return {};
    const char* stop = next_;
    while (stop != end_ && !is_blank(*stop)) ++stop;
    return {next_, static_cast<size_t>(stop - next_)};
  }
  std::string_view word() {
    std::string_view text = peek();
    next_ += text.size();
    return text;
  }

  // The text not yet read, for callers that read parts of a word; skip() passes `size` bytes of it.
  std::string_view rest() const { return {next_, static_cast<size_t>(end_ - next_)}; }
  void skip(size_t size) { next_ += size; }

  // Reads a number; false, with nothing read, if the next word is none.
  template <class T>
  bool number(T& value) {
    if (at_end()) return false;
    const char* stop = parse_number(next_, end_, value);
    if (!stop || (stop != end_ && !is_blank(*stop))) return false;
    next_ = stop;
    return true;
  }

 private:
  const char* next_;
  const char* end_;
  bool comments_;
};

}  // namespace accuray::mesh
