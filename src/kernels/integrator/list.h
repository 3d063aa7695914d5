// All integrators.
#pragma once

#include "kernels/integrator/direct.h"
#include "kernels/integrator/path.h"
#include "kernels/integrator/reference.h"

namespace accuray {

using Integrators = TypeList<PathTracing, DirectLighting, Reference>;

}  // namespace accuray
