// Pictures, and their mipmaps as kernels/texture/mipmap.h reads them.
#pragma once

#include <vector>

#include "kernels/texture/texels.h"
#include "lower/block.h"

namespace accuray {

// A picture's texels as somebody else keeps them: rows from the top, channels next to each other.
struct Picture {
  Section texels;
  uint32_t width, height, channels;
  TexelFormat format;
};

// Number `i` of a picture's texels; `decode` as below.
float stored_number(const Picture& picture, size_t i, const float* decode);

// Levels beyond the picture itself.
uint32_t mipmap_count(uint32_t width, uint32_t height);

// All of them, one after the other. `decode`: what stored integers mean as colours, null if they are divided; alpha
// always is.
std::vector<float> make_mipmaps(const Picture& picture, const float* decode);

}  // namespace accuray
