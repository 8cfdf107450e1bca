// Compiled without contraction of products and sums, as eight_triangles.cc is.

#include "hsdm/spatial/eight_bounds.hh"

#include "hsdm/core/vector_pair.hh"
#include "hsdm/core/wide_vectors.hh"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace hsdm {
namespace {

using Row = EightBounds::Row;
using Rows = EightBounds::Rows;

// of a triangle's corner angle: normals of flatter triangles are not relied on
constexpr double least_sine = 1e-4, least_sine2 = least_sine * least_sine;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double least_number = std::numeric_limits<double>::min();

Double2 two_of(const Row& row, std::size_t k) {
    Double2 lanes;
    std::memcpy(&lanes, row.data() + k, sizeof lanes);
    return lanes;
}

VectorPair two_vectors(const Rows& rows, std::size_t k) {
    return {two_of(rows[0], k), two_of(rows[1], k), two_of(rows[2], k)};
}

void keep(Double2 lanes, Row& row, std::size_t k) {
    std::memcpy(row.data() + k, &lanes, sizeof lanes);
}

void keep(const VectorPair& vectors, Rows& rows, std::size_t k) {
    for (unsigned axis = 0; axis < 3; ++axis) keep(vectors[axis], rows[axis], k);
}

Double2 root(Double2 x) {
    return Double2{std::sqrt(x[0]), std::sqrt(x[1])};
}

void prepare_by_two(EightBounds& t) {
    for (std::size_t k = 0; k < EightBounds::size; k += 2) {
        const VectorPair a = two_vectors(t.corner, k);
        const VectorPair ab = two_vectors(t.out[0], k) - a, ac = two_vectors(t.out[1], k) - a, bc = ac - ab;
        const VectorPair upright = ab % ac;
        const Double2 area = upright | upright, bb = ab | ab, cc = ac | ac;
        const auto regular = area > least_sine2 * bb * cc;
        const auto unit = [&](const VectorPair& way, Double2 squared) {
            return way * (regular ? 1 / root(squared) : Double2{});
        };
        const VectorPair normal = unit(upright, area), far = unit(bc % normal, bc | bc);
        keep(normal, t.normal, k);
        keep(unit(ab % normal, bb), t.out[0], k);
        keep(unit(normal % ac, cc), t.out[1], k);
        keep(far, t.out[2], k);
        keep(regular ? far | ab : Double2{} - least_number, t.across, k);
    }
}

LeastSquares squares_by_two(const EightBounds& t, const Vec3& p, Row& row) {
    const Double2 none = Double2{} + infinity;
    Double2 above = none, beside = none;
    for (std::size_t k = 0; k < EightBounds::size; k += 2) {
        const VectorPair arm = VectorPair(p, p) - two_vectors(t.corner, k);
        const Double2 height = arm | two_vectors(t.normal, k);
        const Double2 beyond =
            max_lanes(max_lanes(arm | two_vectors(t.out[0], k), arm | two_vectors(t.out[1], k)),
                      (arm | two_vectors(t.out[2], k)) - two_of(t.across, k));
        const Double2 squared = square(height) + square(max_lanes(beyond, Double2{}));
        const Double2 bound = beyond > 0 ? squared : none;
        keep(bound, row, k);
        beside = min_lanes(beside, bound);
        above = min_lanes(above, beyond > 0 ? none : squared);
    }
    return {std::min(above[0], above[1]), std::min(beside[0], beside[1])};
}

#ifdef HSDM_WIDE_LANES

HSDM_OF_AVX FourVectors unit_by_avx(const FourVectors& way, __m256d squared, __m256d regular) {
    return scaled(way, _mm256_and_pd(_mm256_set1_pd(1) / _mm256_sqrt_pd(squared), regular));
}

[[gnu::target("avx")]] void prepare_by_avx(EightBounds& t) {
    for (std::size_t k = 0; k < EightBounds::size; k += 4) {
        const FourVectors a = four_at(t.corner, k);
        const FourVectors ab = minus(four_at(t.out[0], k), a), ac = minus(four_at(t.out[1], k), a);
        const FourVectors bc = minus(ac, ab), upright = cross(ab, ac);
        const __m256d area = dot(upright, upright), bb = dot(ab, ab), cc = dot(ac, ac);
        const __m256d regular = _mm256_cmp_pd(area, _mm256_set1_pd(least_sine2) * bb * cc, _CMP_GT_OQ);
        const FourVectors normal = unit_by_avx(upright, area, regular);
        const FourVectors far = unit_by_avx(cross(bc, normal), dot(bc, bc), regular);
        store(normal, t.normal, k);
        store(unit_by_avx(cross(ab, normal), bb, regular), t.out[0], k);
        store(unit_by_avx(cross(normal, ac), cc, regular), t.out[1], k);
        store(far, t.out[2], k);
        _mm256_store_pd(t.across.data() + k,
                        _mm256_blendv_pd(_mm256_set1_pd(-least_number), dot(far, ab), regular));
    }
}

HSDM_OF_AVX double least_of(__m256d four) {
    const __m128d two = _mm_min_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd(four, 1));
    return std::min(two[0], two[1]);
}

[[gnu::target("avx")]] LeastSquares squares_by_avx(const EightBounds& t, const Vec3& p, Row& row) {
    const FourVectors place = four_times(p[0], p[1], p[2]);
    const __m256d zero = _mm256_setzero_pd(), none = _mm256_set1_pd(infinity);
    __m256d above = none, beside = none;
    for (std::size_t k = 0; k < EightBounds::size; k += 4) {
        const FourVectors arm = minus(place, four_at(t.corner, k));
        const __m256d height = dot(arm, four_at(t.normal, k));
        const __m256d near = _mm256_max_pd(dot(arm, four_at(t.out[0], k)), dot(arm, four_at(t.out[1], k)));
        const __m256d far = dot(arm, four_at(t.out[2], k)) - _mm256_load_pd(t.across.data() + k);
        const __m256d beyond = _mm256_max_pd(near, far), out = _mm256_max_pd(beyond, zero);
        const __m256d is_beyond = _mm256_cmp_pd(beyond, zero, _CMP_GT_OQ);
        const __m256d squared = height * height + out * out;
        const __m256d bound = _mm256_blendv_pd(none, squared, is_beyond);
        _mm256_storeu_pd(row.data() + k, bound);
        beside = _mm256_min_pd(beside, bound);
        above = _mm256_min_pd(above, _mm256_blendv_pd(squared, none, is_beyond));
    }
    return {least_of(above), least_of(beside)};
}

// with masks: without, g++ 12 warns of its own headers
HSDM_OF_AVX512 __m512d greater(__m512d a, __m512d b) {
    return _mm512_maskz_max_pd(0xff, a, b);
}

HSDM_OF_AVX512 EightVectors unit_by_avx512(const EightVectors& way, __m512d squared, __mmask8 regular) {
    return scaled(way,
                  _mm512_maskz_mov_pd(regular, _mm512_set1_pd(1) / _mm512_maskz_sqrt_pd(regular, squared)));
}

[[gnu::target("avx512f")]] void prepare_by_avx512(EightBounds& t) {
    const EightVectors a = eight_at(t.corner, 0);
    const EightVectors ab = minus(eight_at(t.out[0], 0), a), ac = minus(eight_at(t.out[1], 0), a);
    const EightVectors bc = minus(ac, ab), upright = cross(ab, ac);
    const __m512d area = dot(upright, upright), bb = dot(ab, ab), cc = dot(ac, ac);
    const __mmask8 regular = _mm512_cmp_pd_mask(area, _mm512_set1_pd(least_sine2) * bb * cc, _CMP_GT_OQ);
    const EightVectors normal = unit_by_avx512(upright, area, regular);
    const EightVectors far = unit_by_avx512(cross(bc, normal), dot(bc, bc), regular);
    store(normal, t.normal, 0);
    store(unit_by_avx512(cross(ab, normal), bb, regular), t.out[0], 0);
    store(unit_by_avx512(cross(normal, ac), cc, regular), t.out[1], 0);
    store(far, t.out[2], 0);
    _mm512_store_pd(t.across.data(),
                    _mm512_mask_mov_pd(_mm512_set1_pd(-least_number), regular, dot(far, ab)));
}

HSDM_OF_AVX512 double least_of(__m512d eight) {
    return least_of(_mm256_min_pd(_mm512_maskz_extractf64x4_pd(0xf, eight, 0),
                                  _mm512_maskz_extractf64x4_pd(0xf, eight, 1)));
}

[[gnu::target("avx512f")]] LeastSquares squares_by_avx512(const EightBounds& t, const Vec3& p, Row& row) {
    const __m512d zero = _mm512_setzero_pd(), none = _mm512_set1_pd(infinity);
    const EightVectors arm = minus(eight_times(p[0], p[1], p[2]), eight_at(t.corner, 0));
    const __m512d height = dot(arm, eight_at(t.normal, 0));
    const __m512d near = greater(dot(arm, eight_at(t.out[0], 0)), dot(arm, eight_at(t.out[1], 0)));
    const __m512d far = dot(arm, eight_at(t.out[2], 0)) - _mm512_load_pd(t.across.data());
    const __m512d beyond = greater(near, far), out = greater(beyond, zero);
    const __mmask8 is_beyond = _mm512_cmp_pd_mask(beyond, zero, _CMP_GT_OQ);
    const __m512d squared = height * height + out * out;
    const __m512d bound = _mm512_mask_mov_pd(none, is_beyond, squared);
    _mm512_storeu_pd(row.data(), bound);
    return {least_of(_mm512_mask_mov_pd(squared, is_beyond, none)), least_of(bound)};
}

#endif

constexpr BoundLanes bounds_by_width[] = {
#ifdef HSDM_WIDE_LANES
    {prepare_by_avx512, squares_by_avx512},
    {prepare_by_avx, squares_by_avx},
#endif
    {prepare_by_two, squares_by_two}};

} // namespace

std::span<const BoundLanes> bound_lanes() {
    return std::span(bounds_by_width).subspan(widest_lanes());
}

} // namespace hsdm
