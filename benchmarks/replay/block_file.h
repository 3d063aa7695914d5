// A lowered scene that was written to a file, loaded at whatever address the memory has now.
#pragma once

#include <string>

#include "lower/block.h"

namespace accuray::bench {

// The file: the number of sections and the size of each, as 64-bit integers of this machine's byte order; then the
// sections, each beginning at a multiple of 16 bytes and followed by 16 bytes that Embree may read. Throws
// std::runtime_error for a file that is not so or whose version is not ours.
Block load_block(const std::string& path);

}  // namespace accuray::bench
