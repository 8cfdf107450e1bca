#include "hsdm/normals/plane_fit.hh"

#include "hsdm/core/lanes.hh"
#include "hsdm/normals/eight_fits.hh"

namespace hsdm {
namespace {

namespace in_both {
using Lanes = Double2;
template <class Held>
bool is_any(const Held& held) {
    return any(held);
}
#define HSDM_OF_LANES inline
#include "hsdm/normals/fit_lanes.inc"
#undef HSDM_OF_LANES
} // namespace in_both

} // namespace

PlaneFit fit_plane(const PlaneSums& sums) {
    PlaneFit result;
    if (!(sums.weight > 0)) return result;
    in_both::PlaneMoments moments;
    moments.weight += sums.weight;
    for (unsigned k = 0; k < 3; ++k) moments.first[k] += sums.first[k];
    for (unsigned k = 0; k < 6; ++k) moments.second[k] += sums.second[k];
    in_both::PlaneLanes fit;
    in_both::fit_planes_to(moments, fit);
    result = plane_along(Vec3(fit.along[0][0], fit.along[1][0], fit.along[2][0]), fit.variance[0],
                         fit.trace[0], fit.gap[0]);
    result.centroid = {fit.centre[0][0], fit.centre[1][0], fit.centre[2][0]};
    return result;
}

PlaneFit plane_along(const Vec3& along, double variance, double trace, double gap) {
    constexpr double negligible = 1e-12;
    PlaneFit fit;
    if (!(trace > 0)) return fit;
    fit.variance = variance;
    if (gap > negligible) fit.normal = along.normalized();
    return fit;
}

} // namespace hsdm
