#include "hsdm/spatial/eight_triangles.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

using namespace hsdm;

TEST_CASE("eight triangles have the feet that each has alone, to the last bit, in lanes of every width",
          "[quality]") {
    support::Random random(4);
    const auto point = [&] {
        return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    };
    std::size_t feet = 0, flat = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const std::size_t count = trial % 3 == 0 ? 5 : EightTriangles::size;
        std::array<std::array<Vec3, 3>, EightTriangles::size> corners;
        const Vec3 a = point(), p = trial % 7 == 0 ? a : point();
        for (std::size_t k = 0; k < count; ++k) {
            const Vec3 b = point();
            const bool without_area = (static_cast<std::size_t>(trial) + k) % 5 == 0;
            corners[k] = {a, b, without_area ? a + (b - a) * random.uniform(-1, 2) : point()};
            flat += without_area;
        }
        for (const TriangleLanes& lanes : triangle_lanes()) {
            EightTriangles eight;
            for (std::size_t k = 0; k < count; ++k) eight.put(k, corners[k][0], corners[k][1], corners[k][2]);
            eight.fill_up(count);
            lanes.prepare(eight);
            const unsigned inside = lanes.feet_inside(eight, p);
            REQUIRE(inside >> count == 0);
            for (std::size_t k = 0; k < count; ++k) {
                NearestOfTriangle alone;
                const bool is_inside =
                    PreparedTriangle(corners[k][0], corners[k][1], corners[k][2]).foot_inside(p, alone);
                REQUIRE(is_inside == (inside >> k & 1u));
                if (!is_inside) continue;
                const NearestOfTriangle foot = eight.foot(k, p);
                CHECK(foot.point == alone.point);
                CHECK(foot.squared_distance == alone.squared_distance);
                CHECK(foot.weights == alone.weights);
                ++feet;
            }
        }
    }
    CHECK(feet > 100);
    CHECK(flat > 100);
}
