#include "hsdm/normals/plane_fit.hh"

#include "hsdm/core/lanes.hh"

#include <cmath>

namespace hsdm {
namespace {

/// Symmetric 3 x 3, two of them at once: xx, yy, zz, xy, yz, zx.
using Symmetric = std::array<Double2, 6>;

/// The cofactors, whose columns are the cross products of the matrix's columns.
Symmetric cofactors(const Symmetric& m) {
    return {m[1] * m[2] - m[4] * m[4], m[2] * m[0] - m[5] * m[5], m[0] * m[1] - m[3] * m[3],
            m[4] * m[5] - m[3] * m[2], m[5] * m[3] - m[4] * m[0], m[3] * m[4] - m[5] * m[1]};
}

/// The smallest eigenvalue of matrices of trace 1 that have no negative one. Newton's method from 0 on comes
/// up to it from below: in three or four steps where points lie near a plane, and where it is repeated, half
/// of the way with each. What becomes of one does not depend on the other.
Double2 smallest_eigenvalue(const Symmetric& m) {
    constexpr int most_steps = 48;
    constexpr double negligible = 1e-15, least_slope = 1e-10; // below that, rounding decides about both
    const Symmetric c = cofactors(m);
    const Double2 minors = c[0] + c[1] + c[2], determinant = m[0] * c[0] + m[3] * c[3] + m[5] * c[5];
    Double2 value{};
    auto rises = value == value;
    for (int step = 0; step < most_steps && any(rises); ++step) {
        const Double2 rest = determinant - ((value - 1) * value + minors) * value;
        const Double2 slope = (3 * value - 2) * value + minors;
        rises &= (rest > negligible * slope) & (slope > least_slope);
        value = rises ? value + rest / slope : value;
    }
    return value;
}

} // namespace

std::array<PlaneFit, 2> fit_planes(const std::array<PlaneSums, 2>& sums) {
    constexpr double negligible = 1e-12;
    const auto both = [&](const auto& value_of) { return Double2{value_of(sums[0]), value_of(sums[1])}; };
    const Double2 weight = both([](const PlaneSums& s) { return s.weight; });
    std::array<Double2, 3> centre;
    for (unsigned k = 0; k < 3; ++k)
        centre[k] = both([k](const PlaneSums& s) { return s.first[k]; }) / weight;
    Symmetric m;
    for (unsigned k = 0; k < 6; ++k)
        m[k] = both([k](const PlaneSums& s) { return s.second[k]; }) / weight
               - centre[k % 3] * centre[k < 3 ? k : (k + 1) % 3];
    const Double2 trace = m[0] + m[1] + m[2];
    for (Double2& entry : m) entry /= trace;
    const Double2 value = smallest_eigenvalue(m);
    for (unsigned k = 0; k < 3; ++k) m[k] -= value;
    // Where the eigenvalue is not repeated, all columns are multiples of its eigenvector, by its components.
    const Symmetric c = cofactors(m);
    const auto x_most = (c[0] >= c[1]) & (c[0] >= c[2]), y_most = c[1] >= c[2];
    const std::array<Double2, 3> column{x_most   ? c[0]
                                        : y_most ? c[3]
                                                 : c[5],
                                        x_most   ? c[3]
                                        : y_most ? c[1]
                                                 : c[4],
                                        x_most   ? c[5]
                                        : y_most ? c[4]
                                                 : c[2]};
    const Double2 gap = c[0] + c[1] + c[2]; // product of the distances to the other two eigenvalues
    std::array<PlaneFit, 2> fits;
    for (std::size_t lane = 0; lane < 2; ++lane) {
        if (!(weight[lane] > 0)) continue;
        fits[lane].centroid = {centre[0][lane], centre[1][lane], centre[2][lane]};
        if (!(trace[lane] > 0)) continue;
        fits[lane].variance = value[lane] * trace[lane];
        if (gap[lane] > negligible)
            fits[lane].normal = Vec3(column[0][lane], column[1][lane], column[2][lane]).normalized();
    }
    return fits;
}

PlaneFit fit_plane(const PlaneSums& sums) {
    return fit_planes({sums, sums})[0];
}

} // namespace hsdm
