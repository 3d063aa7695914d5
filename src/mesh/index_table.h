// A hash table that numbers distinct keys; the keys themselves stay with the caller.
#pragma once

#include <cstdint>
#include <vector>

namespace accuray::mesh {

inline constexpr uint32_t kNone = 0xFFFFFFFFu;

// Mixes three words into a hash whose high bits are good (multiplication by odd 64-bit constants).
inline uint64_t hash_words(uint32_t a, uint32_t b, uint32_t c) {
  uint64_t h = (a + 0x9E3779B97F4A7C15ull * b + 0xC2B2AE3D27D4EB4Full * c) * 0x9FB21C651E98DF25ull;
  return (h ^ (h >> 32)) * 0x9FB21C651E98DF25ull;
}

// Open addressing with linear probing, at most half full: 8 to 16 bytes per key.
class IndexTable {
 public:
  // The number of the stored key for which equal(number) holds; otherwise stores and returns `fresh`, which must be
  // the count of keys so far. hash_of(number) gives the hash of a stored key.
  template <class Equal, class HashOf>
  uint32_t find_or_insert(uint64_t hash, uint32_t fresh, Equal equal, HashOf hash_of) {
    if (2 * (uint64_t{fresh} + 1) > slots_.size()) grow(fresh, hash_of);
    for (uint64_t slot = hash >> shift_;; slot = (slot + 1) & (slots_.size() - 1)) {
      if (slots_[slot] == kNone) return slots_[slot] = fresh;
      if (equal(slots_[slot])) return slots_[slot];
    }
  }

 private:
  template <class HashOf>
  void grow(uint32_t count, HashOf hash_of) {
    --shift_;
    slots_.assign(size_t{1} << (64 - shift_), kNone);
    for (uint32_t number = 0; number < count; ++number) {
      uint64_t slot = hash_of(number) >> shift_;
      while (slots_[slot] != kNone) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = number;
    }
  }

  std::vector<uint32_t> slots_;
  int shift_ = 54;  // first growth: 2^11 slots
};

}  // namespace accuray::mesh
