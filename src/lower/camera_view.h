// How long things are in a camera's picture, for tessellation.
#pragma once

#include "lower/cameras.h"
#include "mesh/splitting.h"

namespace accuray {

// The view of the camera of this type over the world. Distortion by a lens is not counted; a fisheye and a panorama
// count as in the middle of their pictures. Throws as lower_camera() does.
mesh::View camera_view(std::string_view type, const Values& values, const FilmSize& film);

}  // namespace accuray
