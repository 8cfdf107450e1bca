#include "hsdm/normals/plane_fit.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;

TEST_CASE("points of a plane give its normal, whatever its direction", "[normals]") {
    support::Random random(1);
    for (int trial = 0; trial < 200; ++trial) {
        const Vec3 normal = random.direction(), u = (normal % random.direction()).normalized(),
                   v = normal % u;
        PlaneSums sums;
        for (int i = 0; i < 10; ++i)
            sums.add(normal * 0.3 + u * random.gauss() + v * (0.5 * random.gauss()), 1 + random.uniform());
        const PlaneFit fit = fit_plane(sums);
        CHECK(std::abs(fit.normal | normal) > 1 - 1e-12);
        CHECK((fit.centroid | normal) == Approx(0.3));
        CHECK(fit.variance < 1e-12);
    }
}

TEST_CASE("the variance is the mean squared distance from the plane", "[normals]") {
    PlaneSums sums;
    for (double x : {-1.0, 1.0})
        for (double y : {-1.0, 1.0}) {
            sums.add(Vec3(x, y, 0.1), 2);
            sums.add(Vec3(x, y, -0.1), 2);
        }
    const PlaneFit fit = fit_plane(sums);
    CHECK(std::abs(fit.normal[2]) == Approx(1));
    CHECK(fit.variance == Approx(0.01));
}

TEST_CASE("points of a line or of one place span no plane", "[normals]") {
    PlaneSums line, place;
    for (int i = 0; i < 5; ++i) {
        line.add(Vec3(1, 2, 3) * i, 1);
        place.add(Vec3(1, 2, 3), 1);
    }
    CHECK(fit_plane(line).normal == Vec3(0, 0, 0));
    CHECK(fit_plane(place).normal == Vec3(0, 0, 0));
    CHECK(fit_plane(PlaneSums()).normal == Vec3(0, 0, 0));
    support::Random random(2);
    for (int trial = 0; trial < 100; ++trial) {
        const Vec3 direction = random.direction();
        PlaneSums sums;
        for (int i = 0; i < 10; ++i) sums.add(direction * random.gauss(), 1);
        CHECK(fit_plane(sums).normal == Vec3(0, 0, 0));
    }
}
