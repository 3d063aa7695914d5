// Textures of the lowered scene: pictures in sections of their own, and the records that kernels look up.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "kernels/texture/list.h"
#include "lower/block.h"
#include "lower/direction_table.h"
#include "lower/mipmaps.h"
#include "lower/parameters.h"
#include "lower/spectra.h"

namespace accuray {

// What an environment light needs to know of a picture's radiance.
struct RadianceMap {
  DirectionSections directions;
  double mean = 0.0;  // luminance over all directions; that of white is 1
};

// How a texture's picture is read.
struct PictureUse {
  uint32_t picture;
  bool srgb;  // colours are stored with the sRGB curve
};

// A picture, and what has been made of it so far by whether its colours are stored with the sRGB curve: scenes that
// show the picture share them.
struct SharedPicture {
  Picture picture;
  std::map<bool, Section> mipmaps;
  std::map<bool, RadianceMap> radiance;
};

class TexturePool {
 public:
  TexturePool(ParameterPool& pool, SpectrumPool& spectra, std::vector<Section>& bulk)
      : pool_(pool), spectra_(spectra), bulk_(bulk) {}

  // The picture's number; textures that show the same one share it.
  uint32_t add_picture(std::shared_ptr<SharedPicture> picture);
  // The texture's number. Textures that show a picture need one.
  uint32_t add(std::string_view type, const Values& values, std::optional<PictureUse> use);

  const Picture& picture(const PictureUse& use) const { return pictures_.at(use.picture).first->picture; }
  SharedPicture& shared(const PictureUse& use) const { return *pictures_.at(use.picture).first; }
  // What the picture's integers mean as colours, null if they are divided; good until a table is added.
  const float* decoding(const PictureUse& use);

  const std::vector<Tagged>& records() const { return records_; }
  bool any_mipmap() const { return !mipmaps_.empty(); }

 private:
  // The mipmaps of a picture, which all textures that show it so share.
  Mipmaps mipmaps_of(const PictureUse& use);
  void show(ImageTexture& texture, const PictureUse& use);
  uint32_t srgb_table(uint32_t most);
  // Position of the picture's curve in the tables; none: integers are divided.
  uint32_t curve_of(const PictureUse& use);

  ParameterPool& pool_;
  SpectrumPool& spectra_;
  std::vector<Section>& bulk_;
  std::vector<Tagged> records_;
  std::vector<std::pair<std::shared_ptr<SharedPicture>, uint32_t>> pictures_;  // with the section of each
  std::map<uint32_t, uint32_t> srgb_tables_;                                   // by the largest integer
  std::map<std::pair<uint32_t, bool>, Mipmaps> mipmaps_;                       // by picture and curve
};

}  // namespace accuray
