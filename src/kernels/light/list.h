// All lights. The first two can be named in a scene; the others come from shapes whose material emits.
#pragma once

#include "kernels/dispatch.h"
#include "kernels/light/constant.h"
#include "kernels/light/disk.h"
#include "kernels/light/point.h"
#include "kernels/light/quad.h"
#include "kernels/light/sphere.h"
#include "kernels/light/triangle.h"

namespace accuray {

using NamedLights = TypeList<PointLight, ConstantLight>;
using Lights = TypeList<PointLight, ConstantLight, TriangleLight, QuadLight, SphereLight, DiskLight>;

}  // namespace accuray
