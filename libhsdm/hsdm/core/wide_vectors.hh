#pragma once
// Four and eight vectors at once, for files that are compiled with -ffp-contract=off: see wide_lanes.hh.

#include "hsdm/core/wide_lanes.hh"

#ifdef HSDM_WIDE_LANES

#define HSDM_OF_AVX [[gnu::target("avx"), gnu::always_inline]] inline
#define HSDM_OF_AVX512 [[gnu::target("avx512f"), gnu::always_inline]] inline

namespace hsdm {

/// One vector in each lane. Sums are in the order of Vec3's.
struct FourVectors {
    __m256d x, y, z;
};

/// From rows of coordinates, aligned to 64 bytes; those from place k on, a multiple of four.
template <class Rows>
HSDM_OF_AVX FourVectors four_at(const Rows& rows, std::size_t k) {
    return {_mm256_load_pd(rows[0].data() + k), _mm256_load_pd(rows[1].data() + k),
            _mm256_load_pd(rows[2].data() + k)};
}
template <class Rows>
HSDM_OF_AVX void store(const FourVectors& v, Rows& rows, std::size_t k) {
    _mm256_store_pd(rows[0].data() + k, v.x);
    _mm256_store_pd(rows[1].data() + k, v.y);
    _mm256_store_pd(rows[2].data() + k, v.z);
}
/// The same vector in all lanes.
HSDM_OF_AVX FourVectors four_times(double x, double y, double z) {
    return {_mm256_set1_pd(x), _mm256_set1_pd(y), _mm256_set1_pd(z)};
}
HSDM_OF_AVX FourVectors minus(const FourVectors& v, const FourVectors& w) {
    return {v.x - w.x, v.y - w.y, v.z - w.z};
}
HSDM_OF_AVX __m256d dot(const FourVectors& v, const FourVectors& w) {
    return v.x * w.x + v.y * w.y + v.z * w.z;
}
HSDM_OF_AVX FourVectors cross(const FourVectors& v, const FourVectors& w) {
    return {v.y * w.z - v.z * w.y, v.z * w.x - v.x * w.z, v.x * w.y - v.y * w.x};
}
HSDM_OF_AVX FourVectors scaled(const FourVectors& v, __m256d by) {
    return {v.x * by, v.y * by, v.z * by};
}

struct EightVectors {
    __m512d x, y, z;
};

template <class Rows>
HSDM_OF_AVX512 EightVectors eight_at(const Rows& rows, std::size_t k) {
    return {_mm512_load_pd(rows[0].data() + k), _mm512_load_pd(rows[1].data() + k),
            _mm512_load_pd(rows[2].data() + k)};
}
template <class Rows>
HSDM_OF_AVX512 void store(const EightVectors& v, Rows& rows, std::size_t k) {
    _mm512_store_pd(rows[0].data() + k, v.x);
    _mm512_store_pd(rows[1].data() + k, v.y);
    _mm512_store_pd(rows[2].data() + k, v.z);
}
HSDM_OF_AVX512 EightVectors eight_times(double x, double y, double z) {
    return {_mm512_set1_pd(x), _mm512_set1_pd(y), _mm512_set1_pd(z)};
}
HSDM_OF_AVX512 EightVectors minus(const EightVectors& v, const EightVectors& w) {
    return {v.x - w.x, v.y - w.y, v.z - w.z};
}
HSDM_OF_AVX512 __m512d dot(const EightVectors& v, const EightVectors& w) {
    return v.x * w.x + v.y * w.y + v.z * w.z;
}
HSDM_OF_AVX512 EightVectors cross(const EightVectors& v, const EightVectors& w) {
    return {v.y * w.z - v.z * w.y, v.z * w.x - v.x * w.z, v.x * w.y - v.y * w.x};
}
HSDM_OF_AVX512 EightVectors scaled(const EightVectors& v, __m512d by) {
    return {v.x * by, v.y * by, v.z * by};
}

} // namespace hsdm

#endif
