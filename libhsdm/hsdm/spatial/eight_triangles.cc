// Compiled without contraction of products and sums: processors with wide lanes could do both at once, and
// would round once.

#include "hsdm/spatial/eight_triangles.hh"

#include "hsdm/core/vector_pair.hh"
#include "hsdm/core/wide_vectors.hh"

#include <cstring>

namespace hsdm {
namespace {

using Rows = EightTriangles::Rows;

constexpr double least_area = std::numeric_limits<double>::min(); // as in PreparedTriangle

VectorPair two_at(const Rows& rows, std::size_t k) {
    std::array<Double2, 3> lanes;
    for (unsigned axis = 0; axis < 3; ++axis)
        std::memcpy(&lanes[axis], rows[axis].data() + k, sizeof(Double2));
    return {lanes[0], lanes[1], lanes[2]};
}

void store(const VectorPair& vectors, Rows& rows, std::size_t k) {
    for (unsigned axis = 0; axis < 3; ++axis) {
        const Double2 lanes = vectors[axis];
        std::memcpy(rows[axis].data() + k, &lanes, sizeof lanes);
    }
}

void prepare_by_two(EightTriangles& t) {
    for (std::size_t k = 0; k < EightTriangles::size; k += 2) {
        const VectorPair a = two_at(t.a, k), ab = two_at(t.b, k) - a, ac = two_at(t.c, k) - a;
        const VectorPair normal = ab % ac;
        const Double2 area = normal | normal;
        const Double2 per_area = area >= least_area ? 1 / area : Double2{};
        store(normal, t.normal, k);
        store((ac % normal) * per_area, t.towards_b, k);
        store((normal % ab) * per_area, t.towards_c, k);
        std::memcpy(t.per_area.data() + k, &per_area, sizeof per_area);
    }
}

unsigned feet_inside_by_two(const EightTriangles& t, const Vec3& p) {
    const VectorPair place(p, p);
    unsigned inside = 0;
    for (std::size_t k = 0; k < EightTriangles::size; k += 2) {
        const VectorPair ap = place - two_at(t.a, k);
        const Double2 v = ap | two_at(t.towards_b, k), w = ap | two_at(t.towards_c, k);
        Double2 per_area;
        std::memcpy(&per_area, t.per_area.data() + k, sizeof per_area);
        inside |= (lanes_of_two(v >= 0) & lanes_of_two(w >= 0) & lanes_of_two(v + w <= 1)
                   & lanes_of_two(per_area > 0))
                  << k;
    }
    return inside;
}

#ifdef HSDM_WIDE_LANES

[[gnu::target("avx")]] void prepare_by_avx(EightTriangles& t) {
    for (std::size_t k = 0; k < EightTriangles::size; k += 4) {
        const FourVectors a = four_at(t.a, k);
        const FourVectors ab = minus(four_at(t.b, k), a), ac = minus(four_at(t.c, k), a);
        const FourVectors normal = cross(ab, ac);
        const __m256d area = dot(normal, normal);
        const __m256d has_area = _mm256_cmp_pd(area, _mm256_set1_pd(least_area), _CMP_GE_OQ);
        const __m256d per_area = _mm256_and_pd(_mm256_set1_pd(1) / area, has_area);
        store(normal, t.normal, k);
        store(scaled(cross(ac, normal), per_area), t.towards_b, k);
        store(scaled(cross(normal, ab), per_area), t.towards_c, k);
        _mm256_store_pd(t.per_area.data() + k, per_area);
    }
}

[[gnu::target("avx")]] unsigned feet_inside_by_avx(const EightTriangles& t, const Vec3& p) {
    const FourVectors place = four_times(p[0], p[1], p[2]);
    unsigned inside = 0;
    for (std::size_t k = 0; k < EightTriangles::size; k += 4) {
        const FourVectors ap = minus(place, four_at(t.a, k));
        const __m256d v = dot(ap, four_at(t.towards_b, k)), w = dot(ap, four_at(t.towards_c, k));
        const __m256d zero = _mm256_setzero_pd();
        const __m256d in_b = _mm256_cmp_pd(v, zero, _CMP_GE_OQ), in_c = _mm256_cmp_pd(w, zero, _CMP_GE_OQ);
        const __m256d in_a = _mm256_cmp_pd(v + w, _mm256_set1_pd(1), _CMP_LE_OQ);
        const __m256d has_area = _mm256_cmp_pd(_mm256_load_pd(t.per_area.data() + k), zero, _CMP_GT_OQ);
        const __m256d all = _mm256_and_pd(_mm256_and_pd(in_b, in_c), _mm256_and_pd(in_a, has_area));
        inside |= static_cast<unsigned>(_mm256_movemask_pd(all)) << k;
    }
    return inside;
}

[[gnu::target("avx512f")]] void prepare_by_avx512(EightTriangles& t) {
    for (std::size_t k = 0; k < EightTriangles::size; k += 8) {
        const EightVectors a = eight_at(t.a, k);
        const EightVectors ab = minus(eight_at(t.b, k), a), ac = minus(eight_at(t.c, k), a);
        const EightVectors normal = cross(ab, ac);
        const __m512d area = dot(normal, normal);
        const __mmask8 has_area = _mm512_cmp_pd_mask(area, _mm512_set1_pd(least_area), _CMP_GE_OQ);
        const __m512d per_area = _mm512_maskz_mov_pd(has_area, _mm512_set1_pd(1) / area);
        store(normal, t.normal, k);
        store(scaled(cross(ac, normal), per_area), t.towards_b, k);
        store(scaled(cross(normal, ab), per_area), t.towards_c, k);
        _mm512_store_pd(t.per_area.data() + k, per_area);
    }
}

[[gnu::target("avx512f")]] unsigned feet_inside_by_avx512(const EightTriangles& t, const Vec3& p) {
    const EightVectors place = eight_times(p[0], p[1], p[2]);
    unsigned inside = 0;
    for (std::size_t k = 0; k < EightTriangles::size; k += 8) {
        const EightVectors ap = minus(place, eight_at(t.a, k));
        const __m512d v = dot(ap, eight_at(t.towards_b, k)), w = dot(ap, eight_at(t.towards_c, k));
        const __m512d zero = _mm512_setzero_pd();
        __mmask8 all = _mm512_cmp_pd_mask(v, zero, _CMP_GE_OQ);
        all = _mm512_mask_cmp_pd_mask(all, w, zero, _CMP_GE_OQ);
        all = _mm512_mask_cmp_pd_mask(all, v + w, _mm512_set1_pd(1), _CMP_LE_OQ);
        all = _mm512_mask_cmp_pd_mask(all, _mm512_load_pd(t.per_area.data() + k), zero, _CMP_GT_OQ);
        inside |= unsigned{all} << k;
    }
    return inside;
}

#endif

constexpr TriangleLanes triangles_by_width[] = {
#ifdef HSDM_WIDE_LANES
    {prepare_by_avx512, feet_inside_by_avx512},
    {prepare_by_avx, feet_inside_by_avx},
#endif
    {prepare_by_two, feet_inside_by_two}};

} // namespace

std::span<const TriangleLanes> triangle_lanes() {
    return std::span(triangles_by_width).subspan(widest_lanes());
}

} // namespace hsdm
