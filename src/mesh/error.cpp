#include "mesh/error.h"

namespace accuray::mesh {
namespace {

constexpr size_t kMaxQuoted = 60;

// Text fit for a message: no control characters, no bytes beyond ASCII, not long.
std::string printable(std::string_view text) {
  std::string result;
  for (char c : text.substr(0, kMaxQuoted)) result += c >= ' ' && c <= '~' ? c : '?';
  if (text.size() > kMaxQuoted) result += "...";
  return result;
}

std::string message(std::string_view file, Place place, std::string_view subject, std::string_view value,
                    std::string_view problem, std::string_view allowed) {
  std::string text(file);
  if (place.line > 0) {
    text.append(":").append(std::to_string(place.line));
  } else if (place.byte != Place::kNowhere) {
    text.append(": byte ").append(std::to_string(place.byte));
  }
  text.append(": ").append(subject);
  if (!value.empty()) text.append(" '").append(printable(value)).append("'");
  return text.append(" ").append(problem).append(": allowed ").append(allowed);
}

}  // namespace

ReadError::ReadError(std::string_view file, Place place, std::string_view subject, std::string_view value,
                     std::string_view problem, std::string_view allowed)
    : std::runtime_error(message(file, place, subject, value, problem, allowed)),
      file_(file),
      place_(place),
      value_(printable(value)),
      allowed_(allowed) {}

}  // namespace accuray::mesh
