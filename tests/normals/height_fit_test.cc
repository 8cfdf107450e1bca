#include "hsdm/normals/height_fit.hh"

#include "support/random.hh"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>

using namespace hsdm;

TEST_CASE("the tilt is the slope of the quadratic less that of the plane", "[normals]") {
    support::Random random(4);
    for (int trial = 0; trial < 100; ++trial) {
        std::array<double, 6> c;
        for (double& x : c) x = random.uniform(-1, 1);
        HeightSums sums;
        for (const double x : {-1.0, 0.0, 2.0}) // about (1/3, 0): the plane's slope is that of its middle
            for (const double y : {-1.0, 0.0, 1.0})
                sums.add(x, y, c[0] + c[1] * x + c[2] * y + c[3] * x * x + c[4] * x * y + c[5] * y * y);
        const HeightFit fit = sums.fit();
        // Least squares of x^2 over -1, 0, 2 has the slope 8/7; x y and y^2 are even about y = 0.
        CHECK(fit.tilt[0] == Approx(-8.0 / 7 * c[3]).margin(1e-9));
        CHECK(fit.tilt[1] == Approx(-1.0 / 3 * c[4]).margin(1e-9));
        CHECK(fit.variance < 1e-12);
    }
}

TEST_CASE("the tilt of a noisy plane has the variance that is said", "[normals]") {
    support::Random random(9);
    double squares = 0, said = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        HeightSums sums;
        for (int i = 0; i < 16; ++i) // all on one side, as at a border
            sums.add(random.uniform(0, 1), random.uniform(-1, 1), 0.3 * random.gauss());
        const HeightFit fit = sums.fit();
        squares += fit.tilt[0] * fit.tilt[0] + fit.tilt[1] * fit.tilt[1];
        said += fit.variance;
    }
    CHECK(squares == Approx(said).epsilon(0.1));
}

TEST_CASE("points on a line, on a conic or too few give no tilt", "[normals]") {
    HeightSums line, few, circle;
    for (int i = 0; i < 10; ++i) line.add(0.1 * i, 0.2 * i, 0.01 * i * i);
    for (int i = 0; i < 6; ++i) few.add(0.3 * i, 0.1 * i * i, i % 2);
    for (int i = 0; i < 12; ++i) circle.add(std::cos(i), std::sin(i), 0.1 * i);
    for (const HeightSums& sums : {line, few, circle}) {
        CHECK(sums.fit().tilt == std::array<double, 2>{0, 0});
        CHECK(sums.fit().variance == 0);
    }
}
