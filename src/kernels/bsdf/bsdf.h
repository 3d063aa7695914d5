// What every BSDF offers.
//
// A BSDF is a struct X of parameters, as the scene stores them, and the values XAt = X::at(shading point) at one hit.
// It is listed in list.h; the tests of the list check every law that X::keeps claims.
//
// Conventions
//   - Directions are unit vectors that leave the surface, in the local frame whose +z is the shading normal on the
//     front side and, if X::oriented(), whose +x follows dpdu. `wo` points to where the path came from and is given,
//     `wi` to where light comes from.
//   - eval(wo, wi) is f |cos(theta_i)| per lane, pdf(wo, wi) the density of wi per solid angle; both are 0 for
//     perfectly specular (delta) lobes.
//   - sample(wo, u_lobe, u) returns weight = f |cos(theta_i)| / pdf, or the whole weight of a delta lobe. A failed
//     sample has weight 0.
//   - Transmitted radiance is scaled by (eta_o / eta_i)^2, eta_o being the index on the side of wo.
//   - XAt::is_delta() says that all lobes are, XAt::lobe what the others are. A BSDF that finds value and density
//     together has lobes(wo, wi) besides, which gives both; its density is by lane where it depends on which
//     wavelength is the hero.
//   - X::transmits is declared if light goes through the surface: only then are lamps behind it asked.
#pragma once

#include "kernels/bsdf/surface_params.h"
#include "kernels/geometry/texture_point.h"
#include "kernels/schema.h"
#include "kernels/texture/list.h"

namespace accuray {

// Where a BSDF reads its values from: the scene's tables at the path's wavelengths, at one place of the surface.
struct ShadingPoint {
  const SceneView& scene;
  const Wavelengths& wl;
  TexturePoint where;   // set for materials whose record says that they read it
  Spectrum exterior;    // index of refraction on the front side
  uint32_t seed = 0;    // of the streams that a stochastic BSDF draws from
  bool behind = false;  // the path comes from behind the surface

  Spectrum spectrum(SpectrumRef ref) const {
    const SpectrumRecord& s = scene.spectra[ref.index];
    if (is_textured(s.form)) [[unlikely]]
      return textured_spectrum(scene, s, where, wl);
    return evaluate(s, scene.tables, wl);
  }
  float real(const RealRef& ref) const {
    if (ref.texture != none) [[unlikely]]
      return textured_real(scene, ref, where);
    return ref.value;
  }
};

enum Lobe : uint32_t {
  lobe_none = 0,
  lobe_diffuse = 1,
  lobe_specular = 2,  // delta
  lobe_transmission = 4,
  lobe_disperses = 8,  // the direction depends on the wavelength: only the hero goes on
  lobe_glossy = 16     // around a mirrored or refracted direction
};

struct BsdfSample {
  Vec3 wi;
  Spectrum weight;
  float pdf;  // 0 for delta lobes
  uint32_t lobe;
  float eta_scale;  // (eta_i / eta_o)^2 of a refraction, else 1: takes radiance scaling out of the roulette
};

// Value and density in one direction.
struct BsdfLobes {
  Spectrum value;
  Spectrum pdf;  // if each lane were the hero
};

// Chance with which something that has another share in each lane is chosen for all of them: the mean while they go
// together, which is the balance heuristic over which of them might have been the hero (Wilkie et al. 2014, eq. 9).
inline float chance_for_all(Spectrum share, bool hero_decides) { return hero_decides ? share[0] : 0.25f * sum(share); }

inline BsdfSample mirror_sample(Vec3 wo, Spectrum weight) {
  return {{-wo.x, -wo.y, wo.z}, weight, 0.0f, lobe_specular, 1.0f};
}
inline BsdfSample no_sample() { return {{0, 0, 1}, lanes(0.0f), 0.0f, lobe_none, 1.0f}; }

}  // namespace accuray
