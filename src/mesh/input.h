// Bytes of a file or of memory, read once from front to back through a small window.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/error.h"

namespace accuray::mesh {

// A file is read in pieces into one buffer rather than mapped: its pages never count as this process's memory, and a
// file that shrinks meanwhile ends early instead of raising SIGBUS.
class Input {
 public:
  // Throws ReadError if `path` is no regular file or cannot be read.
  static Input open(const std::string& path);

  // `bytes` must outlive the input; `name` stands for the file in messages.
  static Input view(std::string_view bytes, std::string name);

  const std::string& name() const { return name_; }

  // Bytes not yet taken, as the file's size at opening promises.
  uint64_t remaining() const { return size_ > offset() ? size_ - offset() : 0; }

  // Position of the next byte.
  uint64_t offset() const { return window_offset_ + static_cast<uint64_t>(cursor_ - window_); }

  // Number of the line that next_line returned last, counted from 1.
  uint64_t line() const { return line_; }

  // The next line without its end ("\n" or "\r\n"); false at the end. It is valid until the next call. Throws
  // ReadError for a line beyond kMaxLine bytes.
  bool next_line(std::string_view& line);

  // The next `size` bytes, valid until the next call; null if fewer remain.
  const char* take(size_t size) {
    if (static_cast<size_t>(limit_ - cursor_) < size && !refill(size)) return nullptr;
    const char* bytes = cursor_;
    cursor_ += size;
    return bytes;
  }

  static constexpr size_t kMaxLine = size_t{64} << 20;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  explicit Input(std::string name) : name_(std::move(name)) {}

  // Moves the rest of the window to its front and reads on until `size` bytes are there; false if the data end before.
  bool refill(size_t size);

  std::string name_;
  std::unique_ptr<std::FILE, Close> file_;  // null for memory
  std::vector<char> buffer_;                // of a file
  const char* window_ = nullptr;            // bytes [window_, limit_) are in memory
  const char* cursor_ = nullptr;
  const char* limit_ = nullptr;
  uint64_t window_offset_ = 0;
  uint64_t size_ = 0;
  uint64_t line_ = 0;
};

}  // namespace accuray::mesh
