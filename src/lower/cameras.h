// From a camera's parameters to the struct that kernels read.
#pragma once

#include <optional>

#include "kernels/camera/list.h"
#include "lower/block.h"
#include "lower/parameters.h"

namespace accuray {

// The whole picture, in pixels.
struct FilmSize {
  double width, height;

  double aspect() const { return width / height; }
};

// Lowers the camera of this type. Throws BadParameter for what a table cannot say, such as a camera that looks at
// itself.
Tagged lower_camera(std::string_view type, const Values& values, const FilmSize& film, ParameterPool& pool);

// The block seen through another camera, of the kind that it has; nothing if the camera is of another kind.
std::optional<Block> with_camera(const Block& block, std::string_view type, const Values& values, const FilmSize& film);

}  // namespace accuray
