// What a mesh has stored at its vertices.
#pragma once

#include "kernels/texture/texture.h"

namespace accuray {

struct VertexColorTexture {
  static constexpr const char* name = "vertex_color";
  static constexpr const char* doc =
      "The colours of a mesh's vertices, and their alpha, interpolated between them in linear light.";
  static constexpr bool reads_uv = false;
  static constexpr bool reads_colors = true;
  static constexpr auto params() { return NoParams{}; }

  float step() const { return 0x1p-8f; }
  // White where there is no mesh with colours.
  TextureValue value(const SceneView& scene, const TexturePoint& p) const {
    if (p.geometry == none) return lanes(1.0f);
    const Tagged shape = scene.geometries[p.geometry].shape;
    if (shape.tag != tag_of<Mesh>(Shapes{})) return lanes(1.0f);
    const Mesh& mesh = scene.as<Mesh>(shape);
    if (mesh.colors.count == 0) return lanes(1.0f);
    const uint32_t* index = scene.at(mesh.indices) + size_t{3} * p.primitive;
    const float* colors = scene.at(mesh.colors);
    const auto color = [&](uint32_t vertex) {
      const float* c = colors + size_t{4} * vertex;
      return lanes(c[0], c[1], c[2], c[3]);
    };
    const TextureValue first = color(index[0]);
    return fma(lanes(p.on_triangle.x), color(index[1]) - first,
               fma(lanes(p.on_triangle.y), color(index[2]) - first, first));
  }
};

}  // namespace accuray
