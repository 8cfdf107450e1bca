// Compiled without contraction of products and sums: processors with wide lanes could do both at once, and
// would round once.

#include "hsdm/normals/plane_support.hh"

#include "hsdm/core/wide_vectors.hh"
#include "hsdm/normals/neighborhood.hh"

#include <algorithm>
#include <cstring>

namespace hsdm {
namespace {

constexpr std::size_t widest = 8;

Double2 two_at(const std::array<double, Planes::most>& row, std::size_t k) {
    Double2 lanes;
    std::memcpy(&lanes, row.data() + k, sizeof lanes);
    return lanes;
}

/// Calls weight(normals, neighbour) for two normals at a time.
template <class Weight>
void sum_by_two(const Planes& planes, Support& support, const Weight& weight) {
    for (std::size_t k = 0; k < planes.count; k += 2) {
        const auto& rows = planes.normals;
        const VectorPair normals(two_at(rows[0], k), two_at(rows[1], k), two_at(rows[2], k));
        Double2 sum{};
        for (std::size_t j = 0; j < planes.count; ++j) sum += weight(normals, j);
        support[k] = sum[0];
        support[k + 1] = sum[1];
    }
}

Vec3 column(const Planes::Rows& rows, std::size_t j) {
    return {rows[0][j], rows[1][j], rows[2][j]};
}

void near_by_two(const Planes& planes, Support& support) {
    sum_by_two(planes, support, [&](const VectorPair& normals, std::size_t j) {
        return closeness(normals | column(planes.offsets, j), planes.inverse_tolerance);
    });
}

void agreeing_by_two(const Planes& planes, Support& support) {
    sum_by_two(planes, support, [&](const VectorPair& normals, std::size_t j) {
        const Double2 cosine = normals | column(planes.normals, j);
        const Double2 all =
            agreement(cosine) * closeness(normals | column(planes.offsets, j), planes.inverse_tolerance);
        return cosine > 0 ? all : Double2{};
    });
}

#ifdef HSDM_WIDE_LANES

/// The same vector in all lanes.
HSDM_OF_AVX FourVectors four_of(const Planes::Rows& rows, std::size_t j) {
    return four_times(rows[0][j], rows[1][j], rows[2][j]);
}
HSDM_OF_AVX512 EightVectors eight_of(const Planes::Rows& rows, std::size_t j) {
    return eight_times(rows[0][j], rows[1][j], rows[2][j]);
}
/// closeness()
HSDM_OF_AVX __m256d close_four(__m256d residual, double inverse) {
    const __m256d t = residual * _mm256_set1_pd(inverse);
    const __m256d u = _mm256_max_pd(_mm256_set1_pd(1) - t * t, _mm256_setzero_pd());
    return u * u;
}

[[gnu::target("avx")]] void near_by_avx(const Planes& planes, Support& support) {
    for (std::size_t k = 0; k < planes.count; k += 4) {
        const FourVectors normals = four_at(planes.normals, k);
        __m256d sum = _mm256_setzero_pd();
        for (std::size_t j = 0; j < planes.count; ++j)
            sum += close_four(dot(normals, four_of(planes.offsets, j)), planes.inverse_tolerance);
        _mm256_storeu_pd(support.data() + k, sum);
    }
}

[[gnu::target("avx")]] void agreeing_by_avx(const Planes& planes, Support& support) {
    const __m256d least = _mm256_set1_pd(neighborhoods::least_agreement), zero = _mm256_setzero_pd();
    const __m256d range = _mm256_set1_pd(1 - neighborhoods::least_agreement);
    for (std::size_t k = 0; k < planes.count; k += 4) {
        const FourVectors normals = four_at(planes.normals, k);
        __m256d sum = zero;
        for (std::size_t j = 0; j < planes.count; ++j) {
            const __m256d cosine = dot(normals, four_of(planes.normals, j));
            const __m256d agreed = _mm256_max_pd(zero, cosine * cosine - least) / range;
            const __m256d all =
                agreed * close_four(dot(normals, four_of(planes.offsets, j)), planes.inverse_tolerance);
            sum += _mm256_and_pd(all, _mm256_cmp_pd(cosine, zero, _CMP_GT_OQ));
        }
        _mm256_storeu_pd(support.data() + k, sum);
    }
}

/// As _mm512_max_pd(), of which g++ 12 warns within its own header.
HSDM_OF_AVX512 __m512d max_of(__m512d a, __m512d b) {
    return _mm512_maskz_max_pd(0xff, a, b);
}
/// closeness()
HSDM_OF_AVX512 __m512d close_eight(__m512d residual, double inverse) {
    const __m512d t = residual * _mm512_set1_pd(inverse);
    const __m512d u = max_of(_mm512_set1_pd(1) - t * t, _mm512_setzero_pd());
    return u * u;
}

[[gnu::target("avx512f")]] void near_by_avx512(const Planes& planes, Support& support) {
    for (std::size_t k = 0; k < planes.count; k += 8) {
        const EightVectors normals = eight_at(planes.normals, k);
        __m512d sum = _mm512_setzero_pd();
        for (std::size_t j = 0; j < planes.count; ++j)
            sum += close_eight(dot(normals, eight_of(planes.offsets, j)), planes.inverse_tolerance);
        _mm512_storeu_pd(support.data() + k, sum);
    }
}

[[gnu::target("avx512f")]] void agreeing_by_avx512(const Planes& planes, Support& support) {
    const __m512d least = _mm512_set1_pd(neighborhoods::least_agreement), zero = _mm512_setzero_pd();
    const __m512d range = _mm512_set1_pd(1 - neighborhoods::least_agreement);
    for (std::size_t k = 0; k < planes.count; k += 8) {
        const EightVectors normals = eight_at(planes.normals, k);
        __m512d sum = zero;
        for (std::size_t j = 0; j < planes.count; ++j) {
            const __m512d cosine = dot(normals, eight_of(planes.normals, j));
            const __m512d agreed = max_of(zero, cosine * cosine - least) / range;
            const __m512d all =
                agreed * close_eight(dot(normals, eight_of(planes.offsets, j)), planes.inverse_tolerance);
            sum += _mm512_maskz_mov_pd(_mm512_cmp_pd_mask(cosine, zero, _CMP_GT_OQ), all);
        }
        _mm512_storeu_pd(support.data() + k, sum);
    }
}

#endif

constexpr SupportLanes support_by_width[] = {
#ifdef HSDM_WIDE_LANES
    {near_by_avx512, agreeing_by_avx512},
    {near_by_avx, agreeing_by_avx},
#endif
    {near_by_two, agreeing_by_two}};

void fill_up(Planes& planes) {
    const std::size_t end = (planes.count + widest - 1) / widest * widest;
    for (auto& row : planes.normals) std::fill(row.data() + planes.count, row.data() + end, 0.0);
}

} // namespace

std::span<const SupportLanes> support_lanes() {
    return std::span(support_by_width).subspan(widest_lanes());
}

void near_planes(Planes& planes, Support& support) {
    fill_up(planes);
    support_lanes().front().near(planes, support);
}

void agreeing_with_planes(Planes& planes, Support& support) {
    fill_up(planes);
    support_lanes().front().agreeing(planes, support);
}

} // namespace hsdm
