// The sRGB curve.
#pragma once

#include "kernels/math/functions.h"

namespace accuray {

// Linear value of an sRGB one, IEC 61966-2-1.
inline double from_srgb(double x) { return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4); }

}  // namespace accuray
