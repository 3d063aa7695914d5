// All lights: those that a scene can name, and those that come from shapes whose material emits.
#pragma once

#include "kernels/dispatch.h"
#include "kernels/light/constant.h"
#include "kernels/light/directional.h"
#include "kernels/light/disk.h"
#include "kernels/light/environment.h"
#include "kernels/light/ies.h"
#include "kernels/light/point.h"
#include "kernels/light/quad.h"
#include "kernels/light/sky.h"
#include "kernels/light/sphere.h"
#include "kernels/light/spot.h"
#include "kernels/light/sun.h"
#include "kernels/light/triangle.h"

namespace accuray {

using NamedLights =
    TypeList<PointLight, ConstantLight, SpotLight, DirectionalLight, IesLight, EnvironmentLight, SunLight, SkyLight>;
using Lights = TypeList<PointLight, ConstantLight, TriangleLight, QuadLight, SphereLight, DiskLight, SpotLight,
                        DirectionalLight, IesLight, EnvironmentLight, SunLight, SkyLight>;

}  // namespace accuray
