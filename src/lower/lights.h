// Lights of the lowered scene: named ones, and those that come from surfaces whose material emits.
#pragma once

#include <span>
#include <vector>

#include "kernels/light/list.h"
#include "lower/light_tree.h"
#include "lower/motion.h"
#include "lower/parameters.h"
#include "lower/spectra.h"

namespace accuray {

class LightTable {
 public:
  LightTable(ParameterPool& pool, const SpectrumPool& spectra, const MotionPool& motions)
      : pool_(pool), spectra_(spectra), motions_(motions) {}

  // `place`: of a light that is a surface. `table`: numbers that lie behind the light in the pool. `motion`: of its
  // instance, in whose prototype's space the light then is.
  template <class L>
  uint32_t add(const L& light, SpectrumRef emission, bool both_sides, LightPlace place = {none, none, 0},
               std::span<const float> table = {}, uint32_t motion = none) {
    records_.push_back({{tag_of<L>(Lights{}), pool_.add(light, table)}, emission, both_sides ? 1u : 0u, motion});
    places_.push_back(place);
    return static_cast<uint32_t>(records_.size() - 1);
  }
  // Adds the lights of an emissive mesh, in the same space, and returns the light of each triangle. Neighbouring
  // triangles that form a rectangle become one light.
  std::vector<uint32_t> add_mesh(std::span<const float> positions, std::span<const uint32_t> indices,
                                 SpectrumRef emission, bool both_sides, LightPlace place, uint32_t motion = none);

  const std::vector<LightRecord>& records() const { return records_; }
  const std::vector<LightPlace>& places() const { return places_; }
  bool any_textured() const;
  // What of each light's power its texture leaves: see texture_shares() in emission.h.
  void set_shares(std::vector<double> shares) { shares_ = std::move(shares); }
  // What lights are chosen by: their power as the sensor sees it, where they are and where they send light.
  LightTree tree(float scene_radius) const;
  // Running sums over the 470 cells of 1 nm: sensor response times what the lights emit.
  std::vector<float> lambda_cdf(float scene_radius) const;

 private:
  template <class Fn>
  auto with_light(const LightRecord& record, Fn&& fn) const;
  double power_factor(const LightRecord& record, float scene_radius) const;
  std::vector<double> weights(float scene_radius) const;

  ParameterPool& pool_;
  const SpectrumPool& spectra_;
  const MotionPool& motions_;
  std::vector<LightRecord> records_;
  std::vector<LightPlace> places_;
  std::vector<double> shares_;  // one for each light, or none
};

std::vector<uint32_t> lambda_guide(const std::vector<float>& cdf);

}  // namespace accuray
