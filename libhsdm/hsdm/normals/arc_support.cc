// Compiled without contraction of products and sums: processors with wide lanes could do both at once, and
// would round once.

#include "hsdm/normals/arc_support.hh"

#include "hsdm/core/wide_vectors.hh"
#include "hsdm/normals/neighborhood.hh"

#include <algorithm>
#include <cstring>

namespace hsdm {
namespace {

Double2 two_from(const std::array<double, ArcCandidates::most>& row, std::size_t k) {
    Double2 lanes;
    std::memcpy(&lanes, row.data() + k, sizeof lanes);
    return lanes;
}

void arcs_by_two(const ArcNeighbors& neighbors, const ArcCandidates& candidates, ArcSupport& support) {
    const double inverse = neighbors.inverse_tolerance;
    for (std::size_t k = 0; k < candidates.count; k += 2) {
        const VectorPair normals(two_from(candidates.rows[0], k), two_from(candidates.rows[1], k),
                                 two_from(candidates.rows[2], k));
        Double2 plane{}, arc{};
        for (std::size_t j = 0; j < neighbors.count; ++j) {
            const Double2 cosine = max_lanes(Double2{}, normals | neighbors.normals[j]);
            const Double2 rise = normals | neighbors.offsets[j], u = inverse * (rise + neighbors.rises[j]);
            plane += cosine * closeness(rise, inverse);
            arc += cosine * square(max_lanes(Double2{}, 1 - u * u / (2 + 2 * cosine)));
        }
        std::memcpy(support.plane.data() + k, &plane, sizeof plane);
        std::memcpy(support.arc.data() + k, &arc, sizeof arc);
    }
}

#ifdef HSDM_WIDE_LANES

/// The same vector in all lanes.
HSDM_OF_AVX FourVectors four_of(const Vec3& v) {
    return four_times(v[0], v[1], v[2]);
}
HSDM_OF_AVX512 EightVectors eight_of(const Vec3& v) {
    return eight_times(v[0], v[1], v[2]);
}
HSDM_OF_AVX __m256d square_of_positive(__m256d t) {
    const __m256d positive = _mm256_max_pd(_mm256_setzero_pd(), t);
    return positive * positive;
}

[[gnu::target("avx")]] void arcs_by_avx(const ArcNeighbors& neighbors, const ArcCandidates& candidates,
                                        ArcSupport& support) {
    const __m256d inverse = _mm256_set1_pd(neighbors.inverse_tolerance), zero = _mm256_setzero_pd();
    const __m256d one = _mm256_set1_pd(1), two = _mm256_set1_pd(2);
    for (std::size_t k = 0; k < candidates.count; k += 4) {
        const FourVectors normals = four_at(candidates.rows, k);
        __m256d plane = zero, arc = zero;
        for (std::size_t j = 0; j < neighbors.count; ++j) {
            const __m256d cosine = _mm256_max_pd(zero, dot(normals, four_of(neighbors.normals[j])));
            const __m256d rise = dot(normals, four_of(neighbors.offsets[j])), t = rise * inverse;
            const __m256d u = inverse * (rise + _mm256_set1_pd(neighbors.rises[j]));
            plane += cosine * square_of_positive(one - t * t);
            arc += cosine * square_of_positive(one - u * u / (two + two * cosine));
        }
        _mm256_storeu_pd(support.plane.data() + k, plane);
        _mm256_storeu_pd(support.arc.data() + k, arc);
    }
}

/// As _mm512_max_pd(), of which g++ 12 warns within its own header.
HSDM_OF_AVX512 __m512d positive_of(__m512d t) {
    return _mm512_maskz_max_pd(0xff, _mm512_setzero_pd(), t);
}
HSDM_OF_AVX512 __m512d square_of_positive(__m512d t) {
    return positive_of(t) * positive_of(t);
}

[[gnu::target("avx512f")]] void arcs_by_avx512(const ArcNeighbors& neighbors, const ArcCandidates& candidates,
                                               ArcSupport& support) {
    const __m512d inverse = _mm512_set1_pd(neighbors.inverse_tolerance);
    const __m512d one = _mm512_set1_pd(1), two = _mm512_set1_pd(2);
    for (std::size_t k = 0; k < candidates.count; k += 8) {
        const EightVectors normals = eight_at(candidates.rows, k);
        __m512d plane = _mm512_setzero_pd(), arc = _mm512_setzero_pd();
        for (std::size_t j = 0; j < neighbors.count; ++j) {
            const __m512d cosine = positive_of(dot(normals, eight_of(neighbors.normals[j])));
            const __m512d rise = dot(normals, eight_of(neighbors.offsets[j])), t = rise * inverse;
            const __m512d u = inverse * (rise + _mm512_set1_pd(neighbors.rises[j]));
            plane += cosine * square_of_positive(one - t * t);
            arc += cosine * square_of_positive(one - u * u / (two + two * cosine));
        }
        _mm512_storeu_pd(support.plane.data() + k, plane);
        _mm512_storeu_pd(support.arc.data() + k, arc);
    }
}

#endif

constexpr ArcLanes arcs_by_width[] = {
#ifdef HSDM_WIDE_LANES
    arcs_by_avx512, arcs_by_avx,
#endif
    arcs_by_two};

} // namespace

std::span<const ArcLanes> arc_lanes() {
    return std::span(arcs_by_width).subspan(widest_lanes());
}

void support_by_arcs(const ArcNeighbors& neighbors, ArcCandidates& normals, ArcSupport& support) {
    const std::size_t end = (normals.count + 7) / 8 * 8;
    for (auto& row : normals.rows) std::fill(row.data() + normals.count, row.data() + end, 0.0);
    arc_lanes().front()(neighbors, normals, support);
}

} // namespace hsdm
