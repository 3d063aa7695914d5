// The Utah teapot from its Bezier patches.
#pragma once

#include <span>

#include "lower/double3.h"
#include "mesh/mesh.h"

namespace accuray {

// Newell's 32 bicubic patches (Newell 1975; the bottom by Crow 1987), each as segments x segments cells with texture
// coordinates of its own from 0 to 1.
//
// `newell`: 32 x 4 x 4 control points, +Z up, spout to +X, standing on z = 0 and 3.15 high; a patch is
// sum over i, j of B_i(v) B_j(u) p[4 i + j]. The result has +Y up, `center` under its middle and is `height` high.
mesh::MeshData teapot_mesh(std::span<const double> newell, const Double3& center, double height, uint32_t segments,
                           bool smooth);

}  // namespace accuray
