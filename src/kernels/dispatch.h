// Closed lists of types and the one way to go from a run-time tag to a compile-time type.
#pragma once

#include "kernels/port.h"

namespace accuray {

template <class T>
struct Type {
  using type = T;
};

template <class T, class U>
inline constexpr bool is_same = false;
template <class T>
inline constexpr bool is_same<T, T> = true;

template <class... Ts>
struct TypeList {
  static constexpr uint32_t size = sizeof...(Ts);
};

// Calls fn(Type<T>{}) for the T at position `tag` of the list. The lowering writes no tag beyond the list; the last
// type answers for any that is.
template <class T, class... Ts, class Fn>
ACCURAY_INLINE auto dispatch(TypeList<T, Ts...>, uint32_t tag, Fn&& fn) {
  if constexpr (sizeof...(Ts) == 0) {
    return fn(Type<T>{});
  } else {
    if (tag == 0) return fn(Type<T>{});
    return dispatch(TypeList<Ts...>{}, tag - 1, fn);
  }
}

// Position of T in the list; the size of the list if it is not there.
template <class T, class... Ts>
constexpr uint32_t tag_of(TypeList<Ts...>) {
  constexpr bool same[] = {is_same<T, Ts>...};
  for (uint32_t i = 0; i < sizeof...(Ts); ++i) {
    if (same[i]) return i;
  }
  return sizeof...(Ts);
}

// Whether the list begins with the types of `first`, in the same order.
template <class... Ts, class... Fs>
constexpr bool starts_with(TypeList<Ts...> list, TypeList<Fs...> first) {
  return ((tag_of<Fs>(list) == tag_of<Fs>(first)) && ...);
}

}  // namespace accuray
