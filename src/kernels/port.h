// The one file that knows which compiler is running.
//
// Environments that include it, and what each lacks:
//   host   g++ or clang++ for x86-64-v3: has <cmath>, <cstdint>, SSE/AVX2/FMA intrinsics.
//   NVRTC  NVIDIA's run-time compiler, --std=c++20 -default-device: has no standard header at all,
//          but the CUDA built-in functions; vectors of four lanes are plain structs there.
// Everything else in kernels/ is plain C++20 over the names that this file defines.
#pragma once

#if defined(__CUDACC_RTC__)

namespace accuray {
using int32_t = int;
using uint8_t = unsigned char;
using uint16_t = unsigned short;
using uint32_t = unsigned int;
using int64_t = long long;
using uint64_t = unsigned long long;
using size_t = decltype(sizeof(0));

inline float fma(float a, float b, float c) { return fmaf(a, b, c); }
inline double fma(double a, double b, double c) { return ::fma(a, b, c); }
inline float sqrt(float x) { return sqrtf(x); }
inline double sqrt(double x) { return ::sqrt(x); }
inline float floor(float x) { return floorf(x); }
inline double floor(double x) { return ::floor(x); }
inline uint32_t bits_of(float x) { return __float_as_uint(x); }
inline float float_of(uint32_t x) { return __uint_as_float(x); }
inline uint64_t bits_of(double x) { return static_cast<uint64_t>(__double_as_longlong(x)); }
inline double double_of(uint64_t x) { return __longlong_as_double(static_cast<int64_t>(x)); }
inline uint32_t reverse_bits(uint32_t x) { return __brev(x); }

// Four lanes, element by element. The host uses the compiler's own vector type instead.
template <class T>
struct Four {
  T lane[4];
  T& operator[](int i) { return lane[i]; }
  const T& operator[](int i) const { return lane[i]; }
};
using f32x4 = Four<float>;
using u32x4 = Four<uint32_t>;

#define ACCURAY_LANEWISE(V, T, op)                                                                      \
  inline V operator op(V a, V b) { return {{a[0] op b[0], a[1] op b[1], a[2] op b[2], a[3] op b[3]}}; } \
  inline V operator op(V a, T b) { return {{a[0] op b, a[1] op b, a[2] op b, a[3] op b}}; }             \
  inline V operator op(T a, V b) { return {{a op b[0], a op b[1], a op b[2], a op b[3]}}; }             \
  inline V& operator op## = (V & a, V b) { return a = a op b; }                                         \
  inline V& operator op## = (V & a, T b) { return a = a op b; }
ACCURAY_LANEWISE(f32x4, float, +)
ACCURAY_LANEWISE(f32x4, float, -)
ACCURAY_LANEWISE(f32x4, float, *)
ACCURAY_LANEWISE(f32x4, float, /)
ACCURAY_LANEWISE(u32x4, uint32_t, +)
ACCURAY_LANEWISE(u32x4, uint32_t, *)
ACCURAY_LANEWISE(u32x4, uint32_t, ^)
ACCURAY_LANEWISE(u32x4, uint32_t, |)
ACCURAY_LANEWISE(u32x4, uint32_t, &)
ACCURAY_LANEWISE(u32x4, uint32_t, >>)
#undef ACCURAY_LANEWISE

inline f32x4 fma(f32x4 a, f32x4 b, f32x4 c) {
  return {{fma(a[0], b[0], c[0]), fma(a[1], b[1], c[1]), fma(a[2], b[2], c[2]), fma(a[3], b[3], c[3])}};
}
inline f32x4 sqrt(f32x4 a) { return {{sqrt(a[0]), sqrt(a[1]), sqrt(a[2]), sqrt(a[3])}}; }
inline f32x4 max(f32x4 a, f32x4 b) {
  return {{fmaxf(a[0], b[0]), fmaxf(a[1], b[1]), fmaxf(a[2], b[2]), fmaxf(a[3], b[3])}};
}
inline f32x4 min(f32x4 a, f32x4 b) {
  return {{fminf(a[0], b[0]), fminf(a[1], b[1]), fminf(a[2], b[2]), fminf(a[3], b[3])}};
}
inline f32x4 select_greater(f32x4 a, f32x4 b, f32x4 x, f32x4 y) {
  return {{a[0] > b[0] ? x[0] : y[0], a[1] > b[1] ? x[1] : y[1], a[2] > b[2] ? x[2] : y[2], a[3] > b[3] ? x[3] : y[3]}};
}
inline f32x4 float_of(u32x4 a) { return {{float_of(a[0]), float_of(a[1]), float_of(a[2]), float_of(a[3])}}; }
inline f32x4 to_float(u32x4 a) {
  return {{static_cast<float>(static_cast<int32_t>(a[0])), static_cast<float>(static_cast<int32_t>(a[1])),
           static_cast<float>(static_cast<int32_t>(a[2])), static_cast<float>(static_cast<int32_t>(a[3]))}};
}
inline u32x4 to_index(f32x4 a) {
  return {{static_cast<uint32_t>(static_cast<int32_t>(a[0])), static_cast<uint32_t>(static_cast<int32_t>(a[1])),
           static_cast<uint32_t>(static_cast<int32_t>(a[2])), static_cast<uint32_t>(static_cast<int32_t>(a[3]))}};
}
inline u32x4 reverse_bits(u32x4 a) {
  return {{reverse_bits(a[0]), reverse_bits(a[1]), reverse_bits(a[2]), reverse_bits(a[3])}};
}
}  // namespace accuray

#define ACCURAY_INLINE __forceinline__
#define ACCURAY_NOINLINE __noinline__
#define ACCURAY_NO_UNROLL _Pragma("unroll 1")
#define ACCURAY_OFFSET_OF(type, member) static_cast<uint32_t>(__builtin_offsetof(type, member))

#else  // host

#include <immintrin.h>

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace accuray {
using std::int32_t;
using std::int64_t;
using std::size_t;
using std::uint16_t;
using std::uint32_t;
using std::uint64_t;
using std::uint8_t;

inline float fma(float a, float b, float c) { return __builtin_fmaf(a, b, c); }
inline double fma(double a, double b, double c) { return __builtin_fma(a, b, c); }
inline float sqrt(float x) { return __builtin_sqrtf(x); }
inline double sqrt(double x) { return __builtin_sqrt(x); }
inline float floor(float x) { return __builtin_floorf(x); }
inline double floor(double x) { return __builtin_floor(x); }
inline uint32_t bits_of(float x) { return __builtin_bit_cast(uint32_t, x); }
inline float float_of(uint32_t x) { return __builtin_bit_cast(float, x); }
inline uint64_t bits_of(double x) { return __builtin_bit_cast(uint64_t, x); }
inline double double_of(uint64_t x) { return __builtin_bit_cast(double, x); }

// The compilers' vector types give lane-wise operators, with scalars broadcast.
using f32x4 = float __attribute__((vector_size(16)));
using u32x4 = uint32_t __attribute__((vector_size(16)));

inline f32x4 fma(f32x4 a, f32x4 b, f32x4 c) { return _mm_fmadd_ps(a, b, c); }
inline f32x4 sqrt(f32x4 a) { return _mm_sqrt_ps(a); }
inline f32x4 max(f32x4 a, f32x4 b) { return _mm_max_ps(a, b); }
inline f32x4 min(f32x4 a, f32x4 b) { return _mm_min_ps(a, b); }
// By lane: x where a > b, else y.
inline f32x4 select_greater(f32x4 a, f32x4 b, f32x4 x, f32x4 y) { return _mm_blendv_ps(y, x, _mm_cmpgt_ps(a, b)); }
inline f32x4 float_of(u32x4 a) { return reinterpret_cast<f32x4>(a); }
inline f32x4 to_float(u32x4 a) { return _mm_cvtepi32_ps(reinterpret_cast<__m128i>(a)); }
inline u32x4 to_index(f32x4 a) { return reinterpret_cast<u32x4>(_mm_cvttps_epi32(a)); }

// Bit reversal: bytes by one shuffle, nibbles by two table look-ups.
inline u32x4 reverse_bits(u32x4 a) {
  const __m128i bytes = _mm_set_epi8(12, 13, 14, 15, 8, 9, 10, 11, 4, 5, 6, 7, 0, 1, 2, 3);
  const __m128i table = _mm_setr_epi8(0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15);
  const __m128i low = _mm_set1_epi8(0x0f);
  const __m128i x = _mm_shuffle_epi8(reinterpret_cast<__m128i>(a), bytes);
  const __m128i upper = _mm_shuffle_epi8(table, _mm_and_si128(x, low));
  const __m128i lower = _mm_shuffle_epi8(table, _mm_and_si128(_mm_srli_epi16(x, 4), low));
  return reinterpret_cast<u32x4>(_mm_or_si128(_mm_slli_epi16(upper, 4), lower));
}
inline uint32_t reverse_bits(uint32_t x) {
  x = __builtin_bswap32(x);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}
}  // namespace accuray

#define ACCURAY_INLINE inline __attribute__((always_inline))
#define ACCURAY_NOINLINE __attribute__((noinline))
#define ACCURAY_NO_UNROLL
#define ACCURAY_OFFSET_OF(type, member) static_cast<accuray::uint32_t>(offsetof(type, member))

#endif

namespace accuray {
// Constructors of the lane types that read the same in both environments.
inline f32x4 lanes(float a, float b, float c, float d) { return f32x4{a, b, c, d}; }
inline f32x4 lanes(float a) { return lanes(a, a, a, a); }
inline u32x4 lanes_u(uint32_t a, uint32_t b, uint32_t c, uint32_t d) { return u32x4{a, b, c, d}; }
inline u32x4 lanes_u(uint32_t a) { return lanes_u(a, a, a, a); }

template <class T>
constexpr T min(T a, T b) {
  return b < a ? b : a;
}
template <class T>
constexpr T max(T a, T b) {
  return a < b ? b : a;
}
template <class T>
constexpr T clamp(T x, T low, T high) {
  return min(max(x, low), high);
}
constexpr float abs(float x) { return x < 0.0f ? -x : x; }
constexpr double abs(double x) { return x < 0.0 ? -x : x; }
}  // namespace accuray
