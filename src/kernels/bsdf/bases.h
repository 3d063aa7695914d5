// The BSDFs that a coat may lie upon, and the values of any one of them.
//
// A base is found by its tag at every use, so that what is built upon bases exists once for all of them.
#pragma once

#include "kernels/bsdf/conductor.h"
#include "kernels/bsdf/dielectric.h"
#include "kernels/bsdf/diffuse.h"
#include "kernels/bsdf/sheen.h"
#include "kernels/bsdf/thin_dielectric.h"
#include "kernels/dispatch.h"

namespace accuray {

using Bases = TypeList<Diffuse, Conductor, Dielectric, ThinDielectric, Sheen>;

template <class T>
T declared();  // for unevaluated use
template <class Bsdf>
using ValuesOf = decltype(declared<const Bsdf&>().at(declared<const ShadingPoint&>()));

// Room for the values of one of a list's types.
template <class List>
union AnyValues;
template <>
union AnyValues<TypeList<>> {};
template <class T, class... Ts>
union AnyValues<TypeList<T, Ts...>> {
  ValuesOf<T> first;
  AnyValues<TypeList<Ts...>> others;

  AnyValues() {}
  template <class X>
  void set(const ValuesOf<X>& values) {
    if constexpr (is_same<X, T>) {
      first = values;
    } else {
      others.template set<X>(values);
    }
  }
  template <class X>
  const ValuesOf<X>& get() const {
    if constexpr (is_same<X, T>) {
      return first;
    } else {
      return others.template get<X>();
    }
  }
};

// Whether light goes through to the back of the base.
inline bool base_transmits(uint32_t tag) {
  return dispatch(Bases{}, tag, [](auto type) { return requires { decltype(type)::type::transmits; }; });
}

struct BaseAt {
  AnyValues<Bases> values;
  uint32_t tag;

  void set(Tagged base, const ShadingPoint& p) {
    tag = base.tag;
    dispatch(Bases{}, base.tag, [&](auto type) {
      using Bsdf = typename decltype(type)::type;
      values.template set<Bsdf>(p.scene.as<Bsdf>(base).at(p));
    });
  }
  void set(const DielectricAt& interface) {
    tag = tag_of<Dielectric>(Bases{});
    values.set<Dielectric>(interface);
  }
  // Calls fn with the values as what they are.
  template <class Fn>
  ACCURAY_INLINE auto visit(Fn&& fn) const {
    return dispatch(Bases{}, tag, [&](auto type) { return fn(values.template get<typename decltype(type)::type>()); });
  }

  bool is_delta() const {
    return visit([](const auto& base) { return base.is_delta(); });
  }
  uint32_t lobe() const {
    return visit([](const auto& base) { return base.lobe; });
  }
  bool transmits() const { return base_transmits(tag); }
};

}  // namespace accuray
