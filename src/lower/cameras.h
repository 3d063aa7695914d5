// From a camera's parameters to the struct that kernels read.
#pragma once

#include "kernels/camera/list.h"
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

}  // namespace accuray
