// The lowered scene's bytes: section 0 with the root and its tables, and a section for each bulk array.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "kernels/scene_view.h"

namespace accuray {

// Bytes that somebody keeps alive; Embree may read up to 16 bytes past the last vertex, so every owner leaves room.
struct Section {
  std::shared_ptr<const void> owner;
  const uint8_t* data = nullptr;
  size_t size = 0;
};

// Takes over a vector as a section, padded to a multiple of 16 bytes and by 16 more.
template <class T>
Section section_of(std::vector<T> values) {
  const size_t size = values.size() * sizeof(T);
  values.resize(values.size() + 16 / sizeof(T) + 1);
  auto owner = std::make_shared<std::vector<T>>(std::move(values));
  const auto* data = reinterpret_cast<const uint8_t*>(owner->data());
  return {std::move(owner), data, size};
}

class Block {
 public:
  explicit Block(std::vector<Section> sections) : sections_(std::move(sections)) {
    bases_.reserve(sections_.size());
    for (const Section& section : sections_) bases_.push_back(section.data);
  }
  SceneView view() const { return SceneView::of(bases_.data()); }
  const std::vector<Section>& sections() const { return sections_; }
  size_t bytes() const {
    size_t total = 0;
    for (const Section& section : sections_) total += section.size;
    return total;
  }

 private:
  std::vector<Section> sections_;
  std::vector<const uint8_t*> bases_;
};

// Section 0 while it grows: a root, then tables of plain structs at 16-byte boundaries.
class RootWriter {
 public:
  RootWriter() : bytes_(sizeof(Root)) {}

  template <class T>
  Slice<T> append(const std::vector<T>& values) {
    bytes_.resize((bytes_.size() + 15) / 16 * 16);
    const Slice<T> slice{bytes_.size(), 0, static_cast<uint32_t>(values.size())};
    bytes_.resize(bytes_.size() + values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(bytes_.data() + slice.offset, values.data(), values.size() * sizeof(T));
    return slice;
  }
  Section finish(const Root& root) {
    std::memcpy(bytes_.data(), &root, sizeof(Root));
    return section_of(std::move(bytes_));
  }

 private:
  std::vector<uint8_t> bytes_;
};

}  // namespace accuray
