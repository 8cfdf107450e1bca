#include "hsdm/normals/plane_fit.hh"

#include <cmath>
#include <numbers>

namespace hsdm {
namespace {

/// Symmetric 3 x 3: xx, yy, zz, xy, yz, zx.
using Symmetric = std::array<double, 6>;

/// Eigenvalues in ascending order, by the trigonometric solution of the characteristic cubic.
std::array<double, 3> eigenvalues(const Symmetric& m) {
    const double mean = (m[0] + m[1] + m[2]) / 3;
    const double x = m[0] - mean, y = m[1] - mean, z = m[2] - mean;
    const double off = m[3] * m[3] + m[4] * m[4] + m[5] * m[5];
    const double p = std::sqrt((x * x + y * y + z * z + 2 * off) / 6);
    if (p == 0) return {mean, mean, mean};
    const double determinant =
        x * (y * z - m[4] * m[4]) - m[3] * (m[3] * z - m[4] * m[5]) + m[5] * (m[3] * m[4] - y * m[5]);
    const double angle = std::acos(std::clamp(determinant / (2 * p * p * p), -1.0, 1.0)) / 3;
    const double largest = mean + 2 * p * std::cos(angle);
    const double smallest = mean - p * (std::cos(angle) + std::numbers::sqrt3 * std::sin(angle));
    return {smallest, 3 * mean - largest - smallest, largest};
}

/// The eigenvector of an eigenvalue that is not repeated: perpendicular to the rows of m - value.
Vec3 eigenvector(const Symmetric& m, double value) {
    const Vec3 a(m[0] - value, m[3], m[5]), b(m[3], m[1] - value, m[4]), c(m[5], m[4], m[2] - value);
    const Vec3 ab = a % b, bc = b % c, ca = c % a;
    const double lab = ab.sqrnorm(), lbc = bc.sqrnorm(), lca = ca.sqrnorm();
    const Vec3& longest = lab >= lbc && lab >= lca ? ab : lbc >= lca ? bc : ca;
    const double length = longest.norm();
    return length > 0 ? longest / length : Vec3(0, 0, 0);
}

} // namespace

PlaneFit fit_plane(const PlaneSums& sums) {
    PlaneFit fit;
    if (!(sums.weight > 0)) return fit;
    const Vec3 c = fit.centroid = sums.first / sums.weight;
    Symmetric m;
    for (std::size_t k = 0; k < 6; ++k) m[k] = sums.second[k] / sums.weight;
    m[0] -= c[0] * c[0], m[1] -= c[1] * c[1], m[2] -= c[2] * c[2];
    m[3] -= c[0] * c[1], m[4] -= c[1] * c[2], m[5] -= c[2] * c[0];
    const auto values = eigenvalues(m);
    fit.variance = std::max(0.0, values[0]);
    fit.width = std::max(0.0, values[1]);
    constexpr double negligible = 1e-12;
    if (values[1] - values[0] > negligible * values[2]) fit.normal = eigenvector(m, values[0]);
    return fit;
}

} // namespace hsdm
