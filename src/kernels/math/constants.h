// Constants with full precision.
#pragma once

namespace accuray {

constexpr float pi = 3.14159265358979323846f;
constexpr float inv_pi = 0.31830988618379067154f;
constexpr float half_pi = 1.57079632679489661923f;
constexpr float quarter_pi = 0.78539816339744830961f;
constexpr float infinity = __builtin_bit_cast(float, 0x7f800000);
constexpr float one_minus_epsilon = 0x1.fffffep-1f;

}  // namespace accuray
