#include "hsdm/normals/height_fit.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// Powers of x and y in each term: 1, x, y, x x, x y, y y.
constexpr std::array<std::array<std::size_t, 2>, 6> powers{{{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};

} // namespace

/// The normal equations decomposed into l d l^T. With y = l^-1 heights and the columns g, h of l^-1 that
/// belong to x and y, the slope is the sum of y g / d and y h / d over the terms: over the first three it is
/// that of the plane, whose terms they are, and the rest is what the quadratic adds to it.
HeightFit HeightSums::fit() const {
    constexpr double negligible = 1e-10;
    constexpr std::size_t plane_terms = 3;
    const double freedom = moments_[0][0][0] - terms;
    if (freedom <= 0) return {};
    std::array<std::array<Double2, terms>, terms> l{}, ld{};
    std::array<Double2, terms> y{}, g{}, h{}, inverse{};
    HeightFit result;
    Double2 residual = squares_;
    auto determined = residual == residual; // still solvable up to this term
#pragma GCC unroll 6                        // makes all indices constants, which takes a third of the time
    for (std::size_t i = 0; i < terms; ++i) {
        y[i] = heights_[i], g[i] += i == 1, h[i] += i == 2;
        Double2 entry{};
#pragma GCC unroll 6
        for (std::size_t j = 0; j <= i; ++j) {
            entry = moments_[powers[i][0] + powers[j][0]][powers[i][1] + powers[j][1]];
            ld[i][j] = entry;
#pragma GCC unroll 6
            for (std::size_t k = 0; k < j; ++k) ld[i][j] -= ld[i][k] * l[j][k];
            if (j == i) break;
            l[i][j] = ld[i][j] * inverse[j];
            y[i] -= l[i][j] * y[j], g[i] -= l[i][j] * g[j], h[i] -= l[i][j] * h[j];
        }
        determined &= ld[i][i] > negligible * entry;
        inverse[i] = 1 / ld[i][i];
        residual -= y[i] * y[i] * inverse[i];
        if (i < plane_terms) continue;
        result.tilt[0] += y[i] * g[i] * inverse[i], result.tilt[1] += y[i] * h[i] * inverse[i];
        result.variance += (g[i] * g[i] + h[i] * h[i]) * inverse[i];
    }
    result.variance *= max_lanes(Double2{}, residual) / freedom;
    for (Double2* value : {&result.tilt[0], &result.tilt[1], &result.variance})
        *value = determined ? *value : Double2{};
    return result;
}

} // namespace hsdm
