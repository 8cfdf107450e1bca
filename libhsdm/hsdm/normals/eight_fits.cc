// Compiled without contraction of products and sums: processors with wide lanes could do both at once, and
// would round once.

#include "hsdm/normals/eight_fits.hh"

#include "hsdm/core/lanes.hh"
#include "hsdm/core/wide_vectors.hh"

namespace hsdm {
namespace {

namespace in_twos {
using Lanes = Double2;
template <class Held>
inline bool is_any(const Held& held) {
    return any(held);
}
#define HSDM_OF_LANES inline
#include "hsdm/normals/fit_lanes.inc"
#undef HSDM_OF_LANES
} // namespace in_twos

void planes_by_two(const EightOffsets& offsets, EightPlanes& planes) {
    in_twos::fit_eight_planes(offsets, planes);
}
void tilts_by_two(const EightOffsets& offsets, const EightFrames& frames, EightTilts& tilts) {
    in_twos::fit_eight_tilts(offsets, frames, tilts);
}

#ifdef HSDM_WIDE_LANES

namespace in_fours {
using Lanes = double __attribute__((vector_size(32)));
template <class Held>
HSDM_OF_AVX bool is_any(const Held& held) {
    return _mm256_movemask_pd(reinterpret_cast<__m256d>(held)) != 0;
}
#define HSDM_OF_LANES HSDM_OF_AVX
#include "hsdm/normals/fit_lanes.inc"
#undef HSDM_OF_LANES
} // namespace in_fours

[[gnu::target("avx")]] void planes_by_avx(const EightOffsets& offsets, EightPlanes& planes) {
    in_fours::fit_eight_planes(offsets, planes);
}
[[gnu::target("avx")]] void tilts_by_avx(const EightOffsets& offsets, const EightFrames& frames,
                                         EightTilts& tilts) {
    in_fours::fit_eight_tilts(offsets, frames, tilts);
}

namespace in_eights {
using Lanes = double __attribute__((vector_size(64)));
template <class Held>
HSDM_OF_AVX512 bool is_any(const Held& held) {
    return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(held), reinterpret_cast<__m512i>(held)) != 0;
}
#define HSDM_OF_LANES HSDM_OF_AVX512
#include "hsdm/normals/fit_lanes.inc"
#undef HSDM_OF_LANES
} // namespace in_eights

[[gnu::target("avx512f")]] void planes_by_avx512(const EightOffsets& offsets, EightPlanes& planes) {
    in_eights::fit_eight_planes(offsets, planes);
}
[[gnu::target("avx512f")]] void tilts_by_avx512(const EightOffsets& offsets, const EightFrames& frames,
                                                EightTilts& tilts) {
    in_eights::fit_eight_tilts(offsets, frames, tilts);
}

#endif

constexpr FitLanes fits_by_width[] = {
#ifdef HSDM_WIDE_LANES
    {planes_by_avx512, tilts_by_avx512},
    {planes_by_avx, tilts_by_avx},
#endif
    {planes_by_two, tilts_by_two}};

} // namespace

std::span<const FitLanes> fit_lanes() {
    return std::span(fits_by_width).subspan(widest_lanes());
}

PlaneFit EightPlanes::of(std::size_t lane) const {
    return plane_along(Vec3(along[0][lane], along[1][lane], along[2][lane]), variance[lane], trace[lane],
                       gap[lane]);
}

} // namespace hsdm
