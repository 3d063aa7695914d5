// Lights of the lowered scene: named ones, and those that come from surfaces whose material emits.
#pragma once

#include <vector>

#include "kernels/light/list.h"
#include "lower/parameters.h"
#include "lower/spectra.h"

namespace accuray {

class LightTable {
 public:
  LightTable(ParameterPool& pool, const SpectrumPool& spectra) : pool_(pool), spectra_(spectra) {}

  template <class L>
  uint32_t add(const L& light, SpectrumRef emission, bool both_sides) {
    records_.push_back({{tag_of<L>(Lights{}), pool_.add(light)}, emission, both_sides ? 1u : 0u});
    return static_cast<uint32_t>(records_.size() - 1);
  }
  // Adds the lights of an emissive mesh, in world space, and returns the light of each triangle. Neighbouring triangles
  // that form a rectangle become one light.
  std::vector<uint32_t> add_mesh(std::span<const float> positions, std::span<const uint32_t> indices,
                                 SpectrumRef emission, bool both_sides);

  const std::vector<LightRecord>& records() const { return records_; }
  // Running sums of the probabilities with which lights are chosen: in proportion to their power as the sensor sees it.
  std::vector<float> power_cdf(float scene_radius) const;
  // Running sums over the 470 cells of 1 nm: sensor response times what the lights emit.
  std::vector<float> lambda_cdf(float scene_radius) const;

 private:
  double power_factor(const LightRecord& record, float scene_radius) const;
  std::vector<double> weights(float scene_radius) const;

  ParameterPool& pool_;
  const SpectrumPool& spectra_;
  std::vector<LightRecord> records_;
};

std::vector<uint32_t> lambda_guide(const std::vector<float>& cdf);

}  // namespace accuray
