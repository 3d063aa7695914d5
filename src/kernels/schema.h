// What a type says about its parameters, once: the scene validator, `accuray schema`, Python keyword arguments,
// the reference page and the lowering all read these tables.
//
// A type has
//   static constexpr const char* name, *doc;
//   static constexpr auto params() { return Params{Param{...}, ...}; }   // or no_params()
//   static constexpr Keeps keeps = ...;                                   // laws it obeys (BSDFs)
// A Param with a member is written to that place of the type's struct by the lowering; one without a member is
// resolved on the Python side into others (a metal's name into eta and k, a file into arrays).
#pragma once

#include "kernels/port.h"

namespace accuray {

enum class Kind : uint32_t {
  boolean,
  integer,
  real,
  vec,
  choice,
  text,
  file,
  transform,
  array,
  reference,
  spectrum,
  words
};

constexpr uint32_t no_member = 0xffffffffu;
constexpr double unbounded = 1e308;

struct Param {
  const char* name = "";
  Kind kind = Kind::real;
  const char* doc = "";
  const char* preset = "";  // default as JSON text; "" means none
  double low = -unbounded;  // smallest and largest value allowed
  double high = unbounded;
  const char* unit = "";
  const char* choices = "";  // words separated by '|': one of them (choice) or any of them (words)
  const char* role = "";     // reflectance, emission, index; material, shape; shape of an array
  const char* group = "";    // "set:alternative": exactly one alternative of a set is given; "set?:...": at most one
  bool required = false;
  bool texturable = false;      // takes a texture; a real's member is then a RealRef
  const char* untextured = "";  // why it takes none, where one might be expected
  bool takes_flux = false;      // an emission: the flux of the whole emitter may stand for it
  bool animatable = false;
  uint32_t member = no_member;  // byte offset in the type's struct
};

template <uint32_t N>
struct ParamList {
  Param items[N];
  static constexpr uint32_t size = N;
};
template <class... P>
constexpr auto param_list(P... p) {
  return ParamList<sizeof...(P)>{{p...}};
}

template <uint32_t A, uint32_t B>
constexpr ParamList<A + B> joined(const ParamList<A>& a, const ParamList<B>& b) {
  ParamList<A + B> result{};
  for (uint32_t i = 0; i < A; ++i) result.items[i] = a.items[i];
  for (uint32_t i = 0; i < B; ++i) result.items[A + i] = b.items[i];
  return result;
}

struct NoParams {
  static constexpr uint32_t size = 0;
  static constexpr const Param* items = nullptr;
};

// Laws that a BSDF obeys; the list tests check each one that is claimed.
struct Keeps {
  bool exact_pdf = false;          // pdf() is the density of sample()
  bool reciprocal = false;         // f(wi, wo) = f(wo, wi), with 1/eta^2 for transmission
  bool energy_conserving = false;  // albedo never above 1
  bool stochastic = false;         // eval() is only right in expectation
};

}  // namespace accuray
