// All integrators: those that kernels run, and those that scenes name.
#pragma once

#include "kernels/integrator/direct.h"
#include "kernels/integrator/path.h"
#include "kernels/integrator/reference.h"

namespace accuray {

using Integrators = TypeList<PathTracing, Reference>;
using NamedIntegrators = TypeList<PathTracing, DirectLighting, Reference>;

}  // namespace accuray
