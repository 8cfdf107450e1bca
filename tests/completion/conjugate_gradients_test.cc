#include "hsdm/completion/conjugate_gradients.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;

namespace {

/// A chain of unknowns between two known ends.
HarmonicEquations chain(Index n, double begin, double end) {
    HarmonicEquations equations;
    for (Index i = 0; i < n; ++i) {
        if (i > 0) equations.beside.push_back(i - 1);
        if (i + 1 < n) equations.beside.push_back(i + 1);
        equations.first.push_back(static_cast<Index>(equations.beside.size()));
        equations.degree.push_back(2);
        equations.known.push_back((i == 0 ? begin : 0) + (i + 1 == n ? end : 0));
    }
    return equations;
}

} // namespace

TEST_CASE("a harmonic chain is straight", "[completion]") {
    std::vector<double> values(99, 5.0);
    solve_harmonic(chain(99, 1, 3), 1e-12, 1000, values);
    for (std::size_t i = 0; i < values.size(); ++i)
        CHECK(std::abs(values[i] - (1 + 2 * static_cast<double>(i + 1) / 100)) < 1e-9);
}

TEST_CASE("harmonic values that nothing holds, and none at all, stay finite", "[completion]") {
    HarmonicEquations loose;
    for (Index i = 0; i < 2; ++i) {
        loose.beside.push_back(1 - i);
        loose.first.push_back(i + 1);
        loose.degree.push_back(1);
        loose.known.push_back(0);
    }
    std::vector<double> values{1, 3}, none;
    solve_harmonic(loose, 1e-6, 100, values);
    CHECK(values[0] == Approx(2));
    CHECK(values[1] == Approx(2));
    solve_harmonic({}, 1e-6, 100, none);
    CHECK(none.empty());
}

TEST_CASE("the work on harmonic values is bounded", "[completion]") {
    std::vector<double> values(1000, 0.0);
    solve_harmonic(chain(1000, 1, 1), 1e-12, 3, values);
    CHECK(values[0] > 0.3);
    CHECK(values[500] == 0); // three steps reach three neighbours far
}
