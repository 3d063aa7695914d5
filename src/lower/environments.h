// Environment maps of the lowered scene.
#pragma once

#include <map>

#include "lower/direction_table.h"
#include "lower/textures.h"

namespace accuray {

// What an environment light needs of its picture.
struct EnvironmentMap {
  uint32_t texture;  // as which the kernels read it
  DirectionTable table;
  double mean;  // luminance over all directions; that of white is 1
};

// The luminance of a picture: means over cells of what lies between the texels, around the sides, and held at the
// poles. A cell is a texel, a part of one in small pictures, and 2 x 2, 4 x 4, ... of them beyond `most_cells`.
RadianceCells luminance_cells(const Picture& picture, const float* decode);
constexpr uint64_t most_cells = uint64_t{1} << 25;

class EnvironmentPool {
 public:
  EnvironmentPool(TexturePool& textures, std::vector<Section>& bulk) : textures_(textures), bulk_(bulk) {}

  // Lights that show the same picture share all of it.
  const EnvironmentMap& map_of(const PictureUse& use);

 private:
  TexturePool& textures_;
  std::vector<Section>& bulk_;
  std::map<std::pair<uint32_t, bool>, EnvironmentMap> maps_;  // by picture and curve
};

}  // namespace accuray
