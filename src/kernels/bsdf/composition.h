// Materials that are made of others: which part of one shows at a hit.
//
// A composed material has no BSDF. At each hit one of its parts is chosen, by a number that decides about nothing else,
// and is the material there: light found by any technique is then the parts' mixture in expectation. Parts may be
// composed themselves, up to `most_levels` choices deep.
//
// A composition is a struct of parameters with parts() and part(question, u), listed in Compositions.
#pragma once

#include "kernels/bsdf/sheen.h"
#include "kernels/dispatch.h"
#include "kernels/schema.h"
#include "kernels/texture/list.h"

namespace accuray {

constexpr uint32_t most_levels = 16;

struct PartQuestion {
  const SceneView& scene;
  TexturePoint where;  // set for materials whose record says that they read it
  bool behind;         // the path meets the back of the surface
  float cosine;        // between the path and the shading normal, without sign
};

inline float real_at(const PartQuestion& q, const RealRef& ref) {
  return ref.texture == none ? ref.value : textured_real(q.scene, ref, q.where);
}

struct Part {
  uint32_t material;
  bool turned;  // the surface counts as turned around
  float u;      // what is left of the number that decides
  float scale;  // of what the part shows
};

struct Parts {
  uint32_t first, second;
};

struct Mix {
  uint32_t first, second;
  RealRef weight;

  static constexpr const char* name = "mix";
  static constexpr const char* doc = "Two materials side by side, finer than the eye can tell or by a texture.";
  static constexpr auto params() {
    return param_list(Param{.name = "first",
                            .kind = Kind::reference,
                            .doc = "Material of the share 1 - weight.",
                            .role = "material",
                            .required = true,
                            .member = ACCURAY_OFFSET_OF(Mix, first)},
                      Param{.name = "second",
                            .kind = Kind::reference,
                            .doc = "Material of the share weight.",
                            .role = "material",
                            .required = true,
                            .member = ACCURAY_OFFSET_OF(Mix, second)},
                      Param{.name = "weight",
                            .kind = Kind::real,
                            .doc = "Share of the surface that is of the second material.",
                            .preset = "0.5",
                            .low = 0,
                            .high = 1,
                            .unit = "1",
                            .texturable = true,
                            .animatable = true,
                            .member = ACCURAY_OFFSET_OF(Mix, weight)});
  }
  Parts parts() const { return {first, second}; }
  Part part(const PartQuestion& q, float u) const {
    const float w = real_at(q, weight);
    if (u < w) return {second, false, u / w, 1.0f};
    return {first, false, (u - w) / (1.0f - w), 1.0f};
  }
};

struct TwoSided {
  uint32_t front, back;

  static constexpr const char* name = "two_sided";
  static constexpr const char* doc =
      "One material on each side of a surface, both with their front outwards. Not for bodies such as glass.";
  static constexpr auto params() {
    return param_list(Param{.name = "front",
                            .kind = Kind::reference,
                            .doc = "Material of the front.",
                            .role = "material",
                            .required = true,
                            .member = ACCURAY_OFFSET_OF(TwoSided, front)},
                      Param{.name = "back",
                            .kind = Kind::reference,
                            .doc = "Material of the back; that of the front if it is left out.",
                            .role = "material",
                            .member = ACCURAY_OFFSET_OF(TwoSided, back)});
  }
  Parts parts() const { return {front, back}; }
  Part part(const PartQuestion& q, float u) const { return {q.behind ? back : front, q.behind, u, 1.0f}; }
};

// Fibres of directional albedo E scatter the share E of the light and let the rest through to the base. The share is
// that of the path's direction (albedo scaling, as in OpenPBR 1.1), so the whole is reciprocal only as far as E is
// constant.
struct Fuzz {
  uint32_t base, fibres;
  RealRef weight;

  static constexpr const char* name = "fuzz";
  static constexpr const char* doc = "Fibres upon another material: dust, peach skin, velvet on its ground.";
  static constexpr auto params() {
    return param_list(Param{.name = "base",
                            .kind = Kind::reference,
                            .doc = "Material under the fibres.",
                            .role = "material",
                            .required = true,
                            .member = ACCURAY_OFFSET_OF(Fuzz, base)},
                      Param{.name = "fibres",
                            .kind = Kind::reference,
                            .doc = "The fibres: a material of the type sheen.",
                            .role = "material",
                            .required = true,
                            .member = ACCURAY_OFFSET_OF(Fuzz, fibres)},
                      Param{.name = "weight",
                            .kind = Kind::real,
                            .doc = "Share of the surface that has fibres.",
                            .preset = "1",
                            .low = 0,
                            .high = 1,
                            .unit = "1",
                            .texturable = true,
                            .animatable = true,
                            .member = ACCURAY_OFFSET_OF(Fuzz, weight)});
  }
  Parts parts() const { return {base, fibres}; }
  Part part(const PartQuestion& q, float u) const {
    const RealRef& roughness = q.scene.as<Sheen>(q.scene.materials[fibres].bsdf).roughness;
    const float albedo = sheen_albedo(q.cosine, real_at(q, roughness));
    const float share = real_at(q, weight) * albedo;
    if (u < share) return {fibres, false, u / share, 1.0f / albedo};
    return {base, false, (u - share) / (1.0f - share), 1.0f};
  }
};

using Compositions = TypeList<Mix, TwoSided, Fuzz>;

}  // namespace accuray
