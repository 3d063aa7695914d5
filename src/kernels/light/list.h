// All lights: those that can be named in a scene, and those that come from shapes whose material emits.
#pragma once

#include "kernels/dispatch.h"
#include "kernels/light/constant.h"
#include "kernels/light/disk.h"
#include "kernels/light/environment.h"
#include "kernels/light/point.h"
#include "kernels/light/quad.h"
#include "kernels/light/sky.h"
#include "kernels/light/sphere.h"
#include "kernels/light/sun.h"
#include "kernels/light/triangle.h"

namespace accuray {

using NamedLights = TypeList<PointLight, ConstantLight, EnvironmentLight, SunLight, SkyLight>;
using Lights = TypeList<PointLight, ConstantLight, TriangleLight, QuadLight, SphereLight, DiskLight, EnvironmentLight,
                        SunLight, SkyLight>;

}  // namespace accuray
