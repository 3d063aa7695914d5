// Path tracing with every type of every list, from one GPU kernel: built by the tests to see that the kernels are
// device code.
#include "kernels/accel/exhaustive.h"
#include "kernels/integrator/sample.h"

// The view and the request are the same for all threads and stay in constant memory.
extern "C" __global__ void sample_pixels(const __grid_constant__ accuray::SceneView scene,
                                         const __grid_constant__ accuray::Request request, unsigned index,
                                         accuray::Quantized* out) {
  using namespace accuray;
  const uint32_t x = blockIdx.x * blockDim.x + threadIdx.x;
  const uint32_t y = blockIdx.y;
  if (x >= request.width) return;
  const Exhaustive accel{&scene};
  const float inverse_step = 1.0f / scene.root->film_step;
  out[y * request.width + x] = sample_pixel<TypeList<PathTracing>>(scene, accel, request, x, y, index, inverse_step);
}
