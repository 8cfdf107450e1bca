#include "hsdm/spatial/eight_bounds.hh"
#include "hsdm/spatial/point_triangle.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>

using namespace hsdm;

TEST_CASE("bounds of eight triangles are no more than their distances, the same bits in lanes of every width",
          "[quality]") {
    support::Random random(5);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto point = [&] {
        return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    };
    std::size_t above = 0, beside = 0, flat = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const std::size_t count = trial % 3 == 0 ? 5 : EightBounds::size;
        std::array<std::array<Vec3, 3>, EightBounds::size> corners;
        std::array<bool, EightBounds::size> has_area{};
        const Vec3 a = point(), p = trial % 7 == 0 ? a : point();
        for (std::size_t k = 0; k < count; ++k) {
            const Vec3 b = point();
            has_area[k] = (static_cast<std::size_t>(trial) + k) % 5 != 0;
            corners[k] = {a, b, has_area[k] ? point() : a + (b - a) * random.uniform(-1, 2)};
            flat += !has_area[k];
        }
        std::vector<EightBounds::Row> rows;
        std::vector<LeastSquares> least;
        for (const BoundLanes& lanes : bound_lanes()) {
            EightBounds eight;
            for (std::size_t k = 0; k < count; ++k) eight.put(k, corners[k][0], corners[k][1], corners[k][2]);
            if (count < EightBounds::size) eight.fill_up(count);
            lanes.prepare(eight);
            least.push_back(lanes.squares(eight, p, rows.emplace_back()));
            REQUIRE(rows.back() == rows.front());
            REQUIRE(least.back().above == least.front().above);
            REQUIRE(least.back().beyond == least.front().beyond);
        }
        CHECK(least.front().beyond == std::ranges::min(rows.front()));
        double nearest_above = infinity;
        for (std::size_t k = 0; k < EightBounds::size; ++k) {
            const double bound = rows.front()[k];
            if (k >= count) {
                CHECK(bound == rows.front()[count - 1]);
                continue;
            }
            const double squared =
                PreparedTriangle(corners[k][0], corners[k][1], corners[k][2]).nearest(p).squared_distance;
            if (bound < infinity) {
                CHECK(bound <= squared * (1 + 1e-9) + 1e-24);
                ++beside;
            } else {
                REQUIRE(has_area[k]);
                nearest_above = std::min(nearest_above, squared);
                ++above;
            }
        }
        if (nearest_above < infinity)
            CHECK(least.front().above == Approx(nearest_above).margin(1e-20));
        else
            CHECK(least.front().above == infinity);
    }
    CHECK(above > 100);
    CHECK(beside > 100);
    CHECK(flat > 100);
}
