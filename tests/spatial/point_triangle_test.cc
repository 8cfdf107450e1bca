#include "hsdm/spatial/point_triangle.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;

TEST_CASE("no point of a triangle is nearer than the nearest", "[quality]") {
    support::Random random(3);
    const auto point = [&] {
        return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    };
    for (int trial = 0; trial < 500; ++trial) {
        const Vec3 a = point(), b = point(), p = point();
        const Vec3 c = trial % 5 == 0 ? a + (b - a) * random.uniform(-1, 2) : point(); // some without area
        const NearestOfTriangle nearest = PreparedTriangle(a, b, c).nearest(p);
        CHECK(nearest.squared_distance == Approx((p - nearest.point).sqrnorm()).margin(1e-12));
        double least = 100;
        for (int i = 0; i <= 40; ++i)
            for (int j = 0; i + j <= 40; ++j) {
                const double v = i / 40.0, w = j / 40.0;
                const Vec3 q = a + (b - a) * v + (c - a) * w;
                least = std::min(least, (p - q).sqrnorm());
            }
        CHECK(nearest.squared_distance <= least + 1e-12);
        CHECK(std::sqrt(nearest.squared_distance) >= std::sqrt(least) - 0.1); // it is of the triangle
        const auto& w = nearest.weights;
        CHECK(std::min({w[0], w[1], w[2]}) >= -1e-12);
        CHECK(w[0] + w[1] + w[2] == Approx(1));
        CHECK((a * w[0] + b * w[1] + c * w[2] - nearest.point).norm() < 1e-12);
    }
}
