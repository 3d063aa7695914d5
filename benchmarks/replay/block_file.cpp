#include "replay/block_file.h"

#include <fstream>
#include <stdexcept>

namespace accuray::bench {

namespace {

constexpr uint64_t kAlignment = 16;

struct alignas(kAlignment) Line {
  uint64_t words[2];
};

uint64_t aligned(uint64_t size) { return (size + kAlignment - 1) / kAlignment * kAlignment; }

// The whole file at an aligned address.
std::shared_ptr<std::vector<Line>> read_file(const std::string& path, uint64_t& size) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) throw std::runtime_error(path + " cannot be opened");
  size = static_cast<uint64_t>(file.tellg());
  auto bytes = std::make_shared<std::vector<Line>>(size / kAlignment + 1);
  file.seekg(0);
  if (!file.read(reinterpret_cast<char*>(bytes->data()), static_cast<std::streamsize>(size))) {
    throw std::runtime_error(path + " cannot be read");
  }
  return bytes;
}

}  // namespace

Block load_block(const std::string& path) {
  uint64_t size = 0;
  const auto owner = read_file(path, size);
  const auto* bytes = reinterpret_cast<const uint8_t*>(owner->data());
  const auto* header = reinterpret_cast<const uint64_t*>(bytes);
  const std::runtime_error wrong(path + " holds no lowered scene of this version");
  if (size < sizeof(uint64_t) || header[0] == 0 || header[0] > size / sizeof(uint64_t) - 1) throw wrong;

  std::vector<Section> sections;
  uint64_t offset = aligned((1 + header[0]) * sizeof(uint64_t));
  for (uint64_t i = 0; i < header[0]; ++i) {
    const uint64_t length = header[1 + i];
    if (length > size || offset + aligned(length) + kAlignment > size) throw wrong;
    sections.push_back({owner, bytes + offset, length});
    offset += aligned(length) + kAlignment;
  }
  if (sections[0].size < sizeof(Root) || reinterpret_cast<const Root*>(sections[0].data)->version != block_version) {
    throw wrong;
  }
  return Block(std::move(sections));
}

}  // namespace accuray::bench
