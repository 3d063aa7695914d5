// Closed lists of types and the one way to go from a run-time tag to a compile-time type.
#pragma once

#include "kernels/port.h"

namespace accuray {

template <class T>
struct Type {
  using type = T;
};

template <class T, class...>
struct FirstOf {
  using type = T;
};

template <class... Ts>
struct TypeList {
  static constexpr uint32_t size = sizeof...(Ts);
};

// Calls fn(Type<T>{}) for the T at position `tag` of the list; a value-initialised result if there is none.
template <class... Ts, class Fn>
ACCURAY_INLINE auto dispatch(TypeList<Ts...>, uint32_t tag, Fn&& fn) {
  using Result = decltype(fn(Type<typename FirstOf<Ts...>::type>{}));
  Result result{};
  uint32_t position = 0;
  ((tag == position++ ? (result = fn(Type<Ts>{}), true) : false) || ...);
  return result;
}

// Position of T in the list; the size of the list if it is not there.
template <class T, class... Ts>
constexpr uint32_t tag_of(TypeList<Ts...>) {
  constexpr bool same[] = {__is_same(T, Ts)...};
  for (uint32_t i = 0; i < sizeof...(Ts); ++i) {
    if (same[i]) return i;
  }
  return sizeof...(Ts);
}

}  // namespace accuray
