// Compiled without contraction of products and sums: processors with wide lanes could do both at once, and
// would round once.

#include "hsdm/contour/disc_lanes.hh"

#include "hsdm/core/lanes.hh"
#include "hsdm/core/wide_lanes.hh"

#include <cstring>

namespace hsdm {
namespace {

constexpr float generous = 1.001f; // coordinates of a few voxels are off by a ten thousandth of that

template <class Lanes, class Value>
Lanes lanes_at(const Value* values) {
    Lanes lanes;
    std::memcpy(&lanes, values, sizeof lanes);
    return lanes;
}

std::uint64_t behind_by_two(const double* discs, const double* place) {
    const Double2 x = Double2{} + place[0], y = Double2{} + place[1], z = Double2{} + place[2];
    std::uint64_t result = 0;
    for (std::size_t k = 0; k < discs_of_word; k += 2) {
        const auto row = [&](std::size_t axis) {
            return lanes_at<Double2>(discs + axis * discs_of_word + k);
        };
        const Double2 height = row(0) * (x - row(3)) + row(1) * (y - row(4)) + row(2) * (z - row(5));
        result |= std::uint64_t{lanes_of_two(height < Double2{})} << k;
    }
    return result;
}

std::uint64_t near_way_by_four(const float* discs, std::uint64_t marked, const float* way) {
    const Float4 x = Float4{} + way[0], y = Float4{} + way[1], z = Float4{} + way[2];
    std::uint64_t result = 0;
    for (std::size_t k = 0; k < discs_of_word; k += 4) {
        if ((marked >> k & 15) == 0) continue;
        const auto row = [&](std::size_t axis) { return lanes_at<Float4>(discs + axis * discs_of_word + k); };
        const Float4 reach = (row(3) + way[3]) * generous;
        const Float4 squared = square(row(0) - x) + square(row(1) - y) + square(row(2) - z);
        result |= std::uint64_t{lanes_of(squared <= square(reach))} << k;
    }
    return result & marked;
}

#ifdef HSDM_WIDE_LANES

[[gnu::target("avx")]] std::uint64_t behind_by_avx(const double* discs, const double* place) {
    const __m256d x = _mm256_set1_pd(place[0]), y = _mm256_set1_pd(place[1]), z = _mm256_set1_pd(place[2]);
    std::uint64_t result = 0;
    for (std::size_t k = 0; k < discs_of_word; k += 4) {
        const double* const at = discs + k;
        const __m256d a = _mm256_loadu_pd(at) * (x - _mm256_loadu_pd(at + 3 * discs_of_word));
        const __m256d b = _mm256_loadu_pd(at + discs_of_word) * (y - _mm256_loadu_pd(at + 4 * discs_of_word));
        const __m256d c =
            _mm256_loadu_pd(at + 2 * discs_of_word) * (z - _mm256_loadu_pd(at + 5 * discs_of_word));
        const __m256d is_behind = _mm256_cmp_pd(a + b + c, _mm256_setzero_pd(), _CMP_LT_OQ);
        result |= static_cast<std::uint64_t>(_mm256_movemask_pd(is_behind)) << k;
    }
    return result;
}

[[gnu::target("avx")]] std::uint64_t near_way_by_avx(const float* discs, std::uint64_t marked,
                                                     const float* way) {
    const __m256 x = _mm256_set1_ps(way[0]), y = _mm256_set1_ps(way[1]), z = _mm256_set1_ps(way[2]);
    const __m256 half = _mm256_set1_ps(way[3]), wider = _mm256_set1_ps(generous);
    std::uint64_t result = 0;
    for (std::size_t k = 0; k < discs_of_word; k += 8) {
        if ((marked >> k & 255) == 0) continue;
        const float* const at = discs + k;
        const __m256 a = _mm256_loadu_ps(at) - x, b = _mm256_loadu_ps(at + discs_of_word) - y;
        const __m256 c = _mm256_loadu_ps(at + 2 * discs_of_word) - z;
        const __m256 reach = (_mm256_loadu_ps(at + 3 * discs_of_word) + half) * wider;
        const __m256 is_near = _mm256_cmp_ps(a * a + b * b + c * c, reach * reach, _CMP_LE_OQ);
        result |= static_cast<std::uint64_t>(_mm256_movemask_ps(is_near)) << k;
    }
    return result & marked;
}

[[gnu::target("avx512f")]] std::uint64_t behind_by_avx512(const double* discs, const double* place) {
    const __m512d x = _mm512_set1_pd(place[0]), y = _mm512_set1_pd(place[1]), z = _mm512_set1_pd(place[2]);
    std::uint64_t result = 0;
    for (std::size_t k = 0; k < discs_of_word; k += 8) {
        const double* const at = discs + k;
        const __m512d a = _mm512_loadu_pd(at) * (x - _mm512_loadu_pd(at + 3 * discs_of_word));
        const __m512d b = _mm512_loadu_pd(at + discs_of_word) * (y - _mm512_loadu_pd(at + 4 * discs_of_word));
        const __m512d c =
            _mm512_loadu_pd(at + 2 * discs_of_word) * (z - _mm512_loadu_pd(at + 5 * discs_of_word));
        result |= std::uint64_t{_mm512_cmp_pd_mask(a + b + c, _mm512_setzero_pd(), _CMP_LT_OQ)} << k;
    }
    return result;
}

[[gnu::target("avx512f")]] std::uint64_t near_way_by_avx512(const float* discs, std::uint64_t marked,
                                                            const float* way) {
    const __m512 x = _mm512_set1_ps(way[0]), y = _mm512_set1_ps(way[1]), z = _mm512_set1_ps(way[2]);
    const __m512 half = _mm512_set1_ps(way[3]), wider = _mm512_set1_ps(generous);
    std::uint64_t result = 0;
    for (std::size_t k = 0; k < discs_of_word; k += 16) {
        if ((marked >> k & 0xffff) == 0) continue;
        const float* const at = discs + k;
        const __m512 a = _mm512_loadu_ps(at) - x, b = _mm512_loadu_ps(at + discs_of_word) - y;
        const __m512 c = _mm512_loadu_ps(at + 2 * discs_of_word) - z;
        const __m512 reach = (_mm512_loadu_ps(at + 3 * discs_of_word) + half) * wider;
        result |= std::uint64_t{_mm512_cmp_ps_mask(a * a + b * b + c * c, reach * reach, _CMP_LE_OQ)} << k;
    }
    return result & marked;
}

#endif

constexpr DiscLanes discs_by_width[] = {
#ifdef HSDM_WIDE_LANES
    {behind_by_avx512, near_way_by_avx512},
    {behind_by_avx, near_way_by_avx},
#endif
    {behind_by_two, near_way_by_four}};

} // namespace

std::span<const DiscLanes> disc_lanes() {
    return std::span(discs_by_width).subspan(widest_lanes());
}

} // namespace hsdm
