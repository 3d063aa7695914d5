#include "mesh/input.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace accuray::mesh {
namespace {

constexpr size_t kBufferSize = size_t{1} << 20;

}  // namespace

Input Input::open(const std::string& path) {
  std::error_code error;
  std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw ReadError(path, {}, "the file", "", "does not exist", "an existing file");
  if (!std::filesystem::is_regular_file(status)) throw ReadError(path, {}, "this", "", "is no file", "a regular file");

  Input input(path);
  input.file_.reset(std::fopen(path.c_str(), "rb"));
  if (!input.file_) throw ReadError(path, {}, "the file", std::strerror(errno), "cannot be opened", "a readable file");
  std::setvbuf(input.file_.get(), nullptr, _IONBF, 0);
  uint64_t size = std::filesystem::file_size(path, error);
  input.size_ = error ? 0 : size;
  input.buffer_.resize(kBufferSize);
  input.window_ = input.cursor_ = input.limit_ = input.buffer_.data();
  return input;
}

Input Input::view(std::string_view bytes, std::string name) {
  Input input(std::move(name));
  input.size_ = bytes.size();
  input.window_ = input.cursor_ = bytes.data();
  input.limit_ = bytes.data() + bytes.size();
  return input;
}

bool Input::refill(size_t size) {
  size_t kept = static_cast<size_t>(limit_ - cursor_);
  if (!file_) return kept >= size;
  window_offset_ = offset();
  std::memmove(buffer_.data(), cursor_, kept);
  if (size > buffer_.size()) buffer_.resize(std::max(size, 2 * buffer_.size()));
  while (kept < size) {
    size_t got = std::fread(buffer_.data() + kept, 1, buffer_.size() - kept, file_.get());
    if (got == 0) {
      if (std::ferror(file_.get())) {
        throw ReadError(name_, {0, window_offset_ + kept}, "the file", std::strerror(errno), "cannot be read on",
                        "a readable file");
      }
      break;
    }
    kept += got;
  }
  window_ = cursor_ = buffer_.data();
  limit_ = window_ + kept;
  return kept >= size;
}

bool Input::next_line(std::string_view& line) {
  size_t searched = 0;
  const char* end = nullptr;
  for (;;) {
    size_t present = static_cast<size_t>(limit_ - cursor_);
    if (present > searched) end = static_cast<const char*>(std::memchr(cursor_ + searched, '\n', present - searched));
    if (end) break;
    searched = present;
    if (present > kMaxLine) {
      throw ReadError(name_, {line_ + 1, offset()}, "a line", "", "is too long", std::to_string(kMaxLine) + " bytes");
    }
    if (!refill(present + 1)) break;
  }
  if (cursor_ == limit_) return false;
  ++line_;
  const char* stop = end ? end : limit_;
  size_t size = static_cast<size_t>(stop - cursor_);
  line = {cursor_, size > 0 && stop[-1] == '\r' ? size - 1 : size};
  cursor_ = end ? end + 1 : limit_;
  return true;
}

}  // namespace accuray::mesh
