// Compiled without contraction of products and sums: processors with wide lanes could do both at once, and
// would round once.

#include "hsdm/normals/near_lanes.hh"

#include "hsdm/core/lanes.hh"
#include "hsdm/core/wide_lanes.hh"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

namespace hsdm {
namespace {

Float4 four_at(const float* values) {
    Float4 lanes;
    std::memcpy(&lanes, values, sizeof lanes);
    return lanes;
}

/// In words of bits, so that hardly any branch is unpredictable.
std::size_t find_by_four(const NearLanes::Candidates& candidates, const std::array<float, 3>& point,
                         float limit, const NearLanes::Found& found) {
    constexpr std::size_t bits = 64;
    const std::size_t size = candidates.count;
    const std::array<Float4, 3> p{Float4{} + point[0], Float4{} + point[1], Float4{} + point[2]};
    std::size_t count = 0;
    for (std::size_t begin = 0; begin < size; begin += bits) {
        std::uint64_t within = 0;
        for (std::size_t c = begin; c < std::min(begin + bits, size); c += 4) {
            const Float4 squared = square(four_at(candidates.axes[0] + c) - p[0])
                                   + square(four_at(candidates.axes[1] + c) - p[1])
                                   + square(four_at(candidates.axes[2] + c) - p[2]);
            std::memcpy(found.distance + c, &squared, sizeof squared);
            within |= std::uint64_t{lanes_of(squared <= limit)} << (c - begin);
        }
        if (size < begin + bits) within &= (std::uint64_t{1} << (size - begin)) - 1;
        for (; within != 0; within &= within - 1) {
            const std::size_t c = begin + static_cast<std::size_t>(std::countr_zero(within));
            found.near[count] = static_cast<Index>(c);
            found.near_distance[count++] = found.distance[c];
        }
    }
    return count;
}

std::size_t count_by_four(const float* distance, std::size_t count, float limit) {
    Int4 sum{};
    for (std::size_t k = 0; k < count; k += 4) sum -= four_at(distance + k) <= limit;
    return static_cast<std::size_t>(sum[0] + sum[1] + sum[2] + sum[3]);
}

std::size_t keep_one_by_one(const float* distance, std::size_t count, float limit, Index* near) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count; ++k) {
        near[kept] = near[k];
        kept += distance[k] <= limit;
    }
    return kept;
}

#ifdef HSDM_WIDE_LANES

// Those that pass are moved together within a register, and stored with whatever follows them.

[[gnu::target("avx512f,popcnt"), gnu::always_inline]] inline std::size_t bits_of(__mmask16 mask) {
    return static_cast<std::size_t>(__builtin_popcount(mask));
}

[[gnu::target("avx512f,popcnt")]] std::size_t find_by_sixteen(const NearLanes::Candidates& candidates,
                                                              const std::array<float, 3>& point, float limit,
                                                              const NearLanes::Found& found) {
    const __m512 px = _mm512_set1_ps(point[0]), py = _mm512_set1_ps(point[1]), pz = _mm512_set1_ps(point[2]);
    const __m512 most = _mm512_set1_ps(limit);
    __m512i number = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    std::size_t count = 0;
    for (std::size_t c = 0; c < candidates.count; c += 16) {
        const __m512 x = _mm512_loadu_ps(candidates.axes[0] + c) - px;
        const __m512 y = _mm512_loadu_ps(candidates.axes[1] + c) - py;
        const __m512 z = _mm512_loadu_ps(candidates.axes[2] + c) - pz;
        const __m512 squared = x * x + y * y + z * z;
        _mm512_storeu_ps(found.distance + c, squared);
        const unsigned there = candidates.count - c < 16 ? (1u << (candidates.count - c)) - 1 : 0xffffu;
        const __mmask16 within =
            _mm512_mask_cmp_ps_mask(static_cast<__mmask16>(there), squared, most, _CMP_LE_OQ);
        _mm512_storeu_si512(found.near + count, _mm512_maskz_compress_epi32(within, number));
        _mm512_storeu_ps(found.near_distance + count, _mm512_maskz_compress_ps(within, squared));
        count += bits_of(within);
        number = _mm512_add_epi32(number, _mm512_set1_epi32(16));
    }
    return count;
}

[[gnu::target("avx512f,popcnt")]] std::size_t count_by_sixteen(const float* distance, std::size_t count,
                                                               float limit) {
    const __m512 most = _mm512_set1_ps(limit);
    std::size_t within = 0;
    for (std::size_t k = 0; k < count; k += 16)
        within += bits_of(_mm512_cmp_ps_mask(_mm512_loadu_ps(distance + k), most, _CMP_LE_OQ));
    return within;
}

[[gnu::target("avx512f,popcnt")]] std::size_t keep_by_sixteen(const float* distance, std::size_t count,
                                                              float limit, Index* near) {
    const __m512 most = _mm512_set1_ps(limit);
    std::size_t kept = 0; // no more than have been read
    for (std::size_t k = 0; k < count; k += 16) {
        const __mmask16 within = _mm512_cmp_ps_mask(_mm512_loadu_ps(distance + k), most, _CMP_LE_OQ);
        const __m512i those = _mm512_maskz_compress_epi32(within, _mm512_loadu_si512(near + k));
        _mm512_storeu_si512(near + kept, those);
        kept += bits_of(within);
    }
    return kept;
}

#endif

constexpr NearLanes near_by_width[] = {
#ifdef HSDM_WIDE_LANES
    {find_by_sixteen, count_by_sixteen, keep_by_sixteen},
#endif
    {find_by_four, count_by_four, keep_one_by_one}};

} // namespace

std::span<const NearLanes> near_lanes() {
    return std::span(near_by_width).subspan(std::min(widest_lanes(), std::size(near_by_width) - 1));
}

} // namespace hsdm
