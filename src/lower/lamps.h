// Lights that a scene names: their structs, with what a parameter table cannot say.
#pragma once

#include <vector>

#include "kernels/light/list.h"
#include "lower/parameters.h"

namespace accuray {

// A measured distribution of luminous intensity: angles in degrees, rising (horizontal ones from 0 to 360, or a single
// one), and for each horizontal angle the candelas at all vertical ones.
struct Photometry {
  std::vector<double> vertical;
  std::vector<double> horizontal;
  std::vector<double> candela;

  // Its flux in lm, exact for candelas that are bilinear in the angles.
  double lumens() const;
};

// A light, and the numbers that lie right behind it in the pool of parameters.
template <class L>
struct Lamp {
  L light;
  std::vector<float> table;
};

// Throws BadParameter for what a table cannot say, such as a spot light that faces itself.
Lamp<SpotLight> lamp_of(Type<SpotLight> type, const Values& values, const Photometry& photometry);
Lamp<DirectionalLight> lamp_of(Type<DirectionalLight> type, const Values& values, const Photometry& photometry);
Lamp<IesLight> lamp_of(Type<IesLight> type, const Values& values, const Photometry& photometry);
template <class L>
Lamp<L> lamp_of(Type<L>, const Values& values, const Photometry&) {
  return {struct_of<L>(values), {}};
}

// Flux of a named light per unit of its emission; for those that are not infinite.
double lamp_power(std::string_view type, const Values& values, const Photometry& photometry);

}  // namespace accuray
