#pragma once
// Two doubles or four floats at once, in what every 64-bit processor has: GCC's and Clang's vector types.

#include <cstddef>

namespace hsdm {

using Double2 = double __attribute__((vector_size(16)));
using Float4 = float __attribute__((vector_size(16)));
using Int4 = int __attribute__((vector_size(16)));
using Long2 = long long __attribute__((vector_size(16)));

template <class Lanes>
inline Lanes min_lanes(Lanes a, Lanes b) {
    return a < b ? a : b;
}
template <class Lanes>
inline Lanes max_lanes(Lanes a, Lanes b) {
    return a > b ? a : b;
}
template <class Lanes>
inline Lanes clamp01(Lanes t) {
    return min_lanes(max_lanes(t, Lanes{}), Lanes{} + 1);
}
template <class Lanes>
inline Lanes square(Lanes t) {
    return t * t;
}

/// Whether a comparison holds in any lane.
template <class Lanes>
inline bool any(Lanes held) {
    const auto halves = reinterpret_cast<Long2>(held);
    return (halves[0] | halves[1]) != 0;
}

/// A bit for each of two lanes where a comparison of Double2 holds. Of one comparison at a time: g++ takes
/// lanes of several, put together by &, through other registers.
template <class Held>
inline unsigned lanes_of_two(Held held) {
#ifdef __SSE2__
    return static_cast<unsigned>(__builtin_ia32_movmskpd(reinterpret_cast<Double2>(held)));
#else
    return static_cast<unsigned>((held[0] & 1) | (held[1] & 2));
#endif
}
/// A bit for each of four lanes where a comparison holds.
inline unsigned lanes_of(Int4 held) {
#ifdef __SSE2__
    return static_cast<unsigned>(__builtin_ia32_movmskps(reinterpret_cast<Float4>(held)));
#else
    const auto halves = reinterpret_cast<Long2>(held & Int4{1, 2, 4, 8});
    const auto bits = static_cast<unsigned long long>(halves[0] | halves[1]);
    return static_cast<unsigned>(bits | bits >> 32) & 15;
#endif
}

} // namespace hsdm
