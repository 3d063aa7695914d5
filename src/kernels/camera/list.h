// All cameras.
#pragma once

#include "kernels/camera/perspective.h"
#include "kernels/dispatch.h"

namespace accuray {

using Cameras = TypeList<Perspective>;

}  // namespace accuray
