// What an intersector offers: the only template parameter of the kernels.
#pragma once

#include "kernels/dispatch.h"
#include "kernels/scene_view.h"

namespace accuray {

template <class T, class U>
concept Same = is_same<T, U>;

// closest(ray): the nearest hit. transmittance(ray): share of light that passes from the origin to ray.far; 0 or 1
// until a scene holds something that lets part of the light through.
template <class A>
concept Accel = requires(const A& accel, const Ray& ray) {
  { accel.closest(ray) } -> Same<Hit>;
  { accel.transmittance(ray) } -> Same<float>;
};

}  // namespace accuray
