#include "lower/textures.h"

#include <stdexcept>

#include "kernels/math/functions.h"
#include "lower/srgb.h"

namespace accuray {

namespace {

UvMap uv_map(const Values& values) {
  const auto scale = vec_of(values, "uv_scale");
  const auto move = vec_of(values, "uv_translate");
  const SinCosDouble turn = sincos(number_of(values, "uv_rotate"));
  UvMap map{};
  const double rows[2][3] = {{turn.cos * scale[0], -turn.sin * scale[1], move[0]},
                             {turn.sin * scale[0], turn.cos * scale[1], move[1]}};
  for (size_t row = 0; row < 2; ++row) {
    for (size_t column = 0; column < 3; ++column) map.m[row][column] = static_cast<float>(rows[row][column]);
  }
  return map;
}

}  // namespace

uint32_t TexturePool::add_picture(std::shared_ptr<SharedPicture> shared) {
  const Picture& picture = shared->picture;
  if (picture.width == 0 || picture.height == 0 || picture.channels < 1 || picture.channels > 4)
    throw std::invalid_argument("a picture has at least one texel, and one to four channels");
  bulk_.push_back(picture.texels);
  pictures_.emplace_back(std::move(shared), static_cast<uint32_t>(bulk_.size()));
  return static_cast<uint32_t>(pictures_.size() - 1);
}

uint32_t TexturePool::srgb_table(uint32_t most) {
  const auto found = srgb_tables_.find(most);
  if (found != srgb_tables_.end()) return found->second;
  std::vector<float> table(most + 1);
  for (uint32_t i = 0; i <= most; ++i) table[i] = static_cast<float>(from_srgb(static_cast<double>(i) / most));
  return srgb_tables_[most] = spectra_.add_table(table);
}

uint32_t TexturePool::curve_of(const PictureUse& use) {
  const TexelFormat format = picture(use).format;
  if (use.srgb && format == TexelFormat::u8) return srgb_table(0xffu);
  if (use.srgb && format == TexelFormat::u16) return srgb_table(0xffffu);
  return none;
}

const float* TexturePool::decoding(const PictureUse& use) {
  const uint32_t curve = curve_of(use);
  return curve == none ? nullptr : spectra_.tables().data() + curve;
}

void TexturePool::show(ImageTexture& texture, const PictureUse& use) {
  const Picture& picture = this->picture(use);
  texture.texels = {0, pictures_.at(use.picture).second, 0};
  texture.width = picture.width;
  texture.height = picture.height;
  texture.channels = picture.channels;
  texture.format = picture.format;
  texture.decode = curve_of(use);
  if (texture.filter == TexelFilter::mipmap) texture.mipmaps = mipmaps_of(use);
}

Mipmaps TexturePool::mipmaps_of(const PictureUse& use) {
  const auto found = mipmaps_.find({use.picture, use.srgb});
  if (found != mipmaps_.end()) return found->second;
  const Picture& picture = this->picture(use);
  Section& made = shared(use).mipmaps[use.srgb];
  if (made.data == nullptr) made = section_of(make_mipmaps(picture, decoding(use)));
  bulk_.push_back(made);
  const auto section = static_cast<uint32_t>(bulk_.size());
  const Mipmaps mipmaps{{0, section, static_cast<uint32_t>(made.size / sizeof(float))},
                        mipmap_count(picture.width, picture.height)};
  return mipmaps_[{use.picture, use.srgb}] = mipmaps;
}

uint32_t TexturePool::add(std::string_view type, const Values& values, std::optional<PictureUse> use) {
  const uint32_t tag = tag_named(Textures{}, type);
  const uint32_t offset = dispatch(Textures{}, tag, [&](auto listed) {
    auto texture = struct_of<typename decltype(listed)::type>(values);
    if constexpr (requires { texture.map; }) texture.map = uv_map(values);
    if constexpr (requires { texture.texels; }) {
      if (!use) throw std::invalid_argument("the texture has no picture");
      show(texture, *use);
    }
    return pool_.add(texture);
  });
  records_.push_back({tag, offset});
  return static_cast<uint32_t>(records_.size() - 1);
}

}  // namespace accuray
