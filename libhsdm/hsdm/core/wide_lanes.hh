#pragma once
// Which lanes wider than those of every 64-bit processor there are. What is written for them stands in files
// that are compiled with -ffp-contract=off, in functions for one width each.

#include <cstddef>

#if defined(__x86_64__) && defined(__GNUC__)
#define HSDM_WIDE_LANES
#include <immintrin.h>
#endif

namespace hsdm {

/// Of functions for 512 bits (AVX-512 F), 256 (AVX) and 128, in this order, the first that this processor can
/// run; where there are those for 128 bits alone the only one.
inline std::size_t widest_lanes() {
#ifdef HSDM_WIDE_LANES
    static const std::size_t widest = __builtin_cpu_supports("avx512f") ? 0
                                      : __builtin_cpu_supports("avx")   ? 1
                                                                        : 2;
    return widest;
#else
    return 0;
#endif
}

} // namespace hsdm
