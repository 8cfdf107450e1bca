#include "hsdm/normals/height_fit.hh"

#include "support/random.hh"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>

using namespace hsdm;

TEST_CASE("the tilt is the slope of the quadratic less that of the plane, of each of two sets", "[normals]") {
    support::Random random(4);
    for (int trial = 0; trial < 100; ++trial) {
        std::array<Double2, 6> c;
        for (Double2& x : c) x = Double2{random.uniform(-1, 1), random.uniform(-1, 1)};
        HeightSums sums;
        for (const double x : {-1.0, 0.0, 2.0}) // about (1/3, 0): the plane's slope is that of its middle
            for (const double y : {-1.0, 0.0, 1.0})
                sums.add(Double2{x, y}, Double2{y, x}, // the other set has its axes swapped
                         c[0] + c[1] * Double2{x, y} + c[2] * Double2{y, x} + c[3] * Double2{x * x, y * y}
                             + c[4] * (x * y) + c[5] * Double2{y * y, x * x});
        const HeightFit fit = sums.fit();
        // Least squares of x^2 over -1, 0, 2 has the slope 8/7; x y and y^2 are even about y = 0.
        CHECK(fit.tilt[0][0] == Approx(-8.0 / 7 * c[3][0]).margin(1e-9));
        CHECK(fit.tilt[1][0] == Approx(-1.0 / 3 * c[4][0]).margin(1e-9));
        CHECK(fit.tilt[1][1] == Approx(-8.0 / 7 * c[5][1]).margin(1e-9));
        CHECK(fit.tilt[0][1] == Approx(-1.0 / 3 * c[4][1]).margin(1e-9));
        CHECK(fit.variance[0] < 1e-12);
        CHECK(fit.variance[1] < 1e-12);
    }
}

TEST_CASE("the tilt of a noisy plane has the variance that is said", "[normals]") {
    support::Random random(9);
    const auto uniform = [&](double least) {
        return Double2{random.uniform(least, 1), random.uniform(least, 1)};
    };
    Double2 squares{}, said{};
    for (int trial = 0; trial < 4000; ++trial) {
        HeightSums sums;
        for (int i = 0; i < 16; ++i) { // all on one side, as at a border
            const Double2 x = uniform(0), y = uniform(-1);
            sums.add(x, y, Double2{0.3 * random.gauss(), 0.2 * random.gauss()});
        }
        const HeightFit fit = sums.fit();
        squares += square(fit.tilt[0]) + square(fit.tilt[1]);
        said += fit.variance;
    }
    CHECK(squares[0] == Approx(said[0]).epsilon(0.1));
    CHECK(squares[1] == Approx(said[1]).epsilon(0.1));
}

TEST_CASE("points on a line, on a conic or too few give no tilt, whatever the other set", "[normals]") {
    support::Random random(3);
    const auto beside = [&](double x) { return Double2{x, random.uniform(-1, 1)}; };
    HeightSums line, few, circle;
    for (int i = 0; i < 10; ++i) line.add(beside(0.1 * i), beside(0.2 * i), beside(0.01 * i * i));
    for (int i = 0; i < 6; ++i) few.add(beside(0.3 * i), beside(0.1 * i * i), beside(i % 2));
    for (int i = 0; i < 12; ++i) circle.add(beside(std::cos(i)), beside(std::sin(i)), beside(0.1 * i));
    for (const HeightSums& sums : {line, few, circle}) {
        const HeightFit fit = sums.fit();
        CHECK(fit.tilt[0][0] == 0);
        CHECK(fit.tilt[1][0] == 0);
        CHECK(fit.variance[0] == 0);
    }
    CHECK(circle.fit().variance[1] > 0);
}
