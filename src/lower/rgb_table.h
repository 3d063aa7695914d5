// The table behind `kernels/spectrum/rgb.h`: sigmoid coefficients for a grid of RGB colours (Jakob and Hanika 2019).
#pragma once

#include <array>
#include <span>
#include <vector>

namespace accuray {

// Linear Rec.709 to CIE XYZ (white Y = 1), row-major; derived from the primaries and white of ITU-R BT.709.
inline constexpr std::array<double, 9> kRec709ToXyz = {0.412390799266, 0.357584339384, 0.180480788402,
                                                       0.212639005872, 0.715168678768, 0.072192315361,
                                                       0.019330818716, 0.119194779795, 0.950532152250};

// Nodes per axis that the renderer uses: the smallest that keeps the colour errors stated in rgb_table_test.cpp.
inline constexpr int kRgbTableNodes = 32;

// The n nodes of the largest component: smoothstep applied twice to k/(n-1), dense towards 0 and 1.
std::vector<float> rgb_table_scale_nodes(int n);

// Fits one spectrum to every node: float [3][n][n][n][3], the layout that `RgbTable` documents.
// n: nodes per axis, 2 to 256.
// cmf: colour matching functions, row-major [471][3], 360 to 830 nm in steps of 1 nm.
// illuminant: relative spectral power of the white of the RGB space, [95], 360 to 830 nm in steps of 5 nm.
// threads: threads to use, at least 1. The result has the same bits for any number of threads and on any machine that
// rounds as IEEE 754 says: only + - * / and sqrt are used, and the build forbids contraction to fma.
// Throws std::invalid_argument for an array of another size or a value that is not finite.
std::vector<float> build_rgb_table(int n, std::span<const double> cmf, std::span<const double> illuminant, int threads,
                                   const std::array<double, 9>& rgb_to_xyz = kRec709ToXyz);

}  // namespace accuray
