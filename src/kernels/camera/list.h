// All cameras. Scenes name those of the first list; a perspective camera with an aperture becomes a thin lens.
#pragma once

#include "kernels/camera/fisheye.h"
#include "kernels/camera/intrinsics.h"
#include "kernels/camera/orthographic.h"
#include "kernels/camera/panorama.h"
#include "kernels/camera/perspective.h"
#include "kernels/camera/thin_lens.h"
#include "kernels/dispatch.h"

namespace accuray {

using NamedCameras = TypeList<Perspective, Orthographic, Panorama, Fisheye, PinholeIntrinsics>;
using Cameras = TypeList<Perspective, ThinLens, Orthographic, Panorama, Fisheye, PinholeIntrinsics>;

}  // namespace accuray
