#include "hsdm/contour/disc_lanes.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <array>

using namespace hsdm;

TEST_CASE("lanes of every width say the same of all discs, to the last bit", "[contour]") {
    const DiscLanes& narrowest = disc_lanes().back();
    support::Random random(11);
    std::array<double, 6 * discs_of_word> planes;
    std::array<float, 4 * discs_of_word> spheres;
    std::size_t behind = 0, near = 0;
    for (int round = 0; round < 2000; ++round) {
        for (double& x : planes) x = random.uniform(-1, 1);
        for (float& x : spheres) x = static_cast<float>(random.uniform(-1, 1));
        std::array<double, 3> place;
        for (double& x : place) x = random.uniform(-1, 1);
        std::array<float, 4> way;
        for (float& x : way) x = static_cast<float>(random.uniform(-1, 1));
        if (round % 2 == 0) { // the first disc passes through the place, but for rounding
            for (std::size_t axis = 0; axis < 3; ++axis)
                planes[(axis + 3) * discs_of_word] = place[axis] * (1 + random.uniform(-1e-15, 1e-15));
            // ... and the first sphere touches the way
            spheres[0] = way[0] + spheres[3 * discs_of_word] + way[3];
            spheres[discs_of_word] = way[1];
            spheres[2 * discs_of_word] = way[2];
        }
        const std::uint64_t marked = ~std::uint64_t{0} << round % 64;
        const std::uint64_t expected_behind = narrowest.behind(planes.data(), place.data());
        const std::uint64_t expected_near = narrowest.near_way(spheres.data(), marked, way.data());
        behind += expected_behind & 1;
        near += (expected_near & 2) != 0;
        for (const DiscLanes& lanes : disc_lanes()) {
            REQUIRE(lanes.behind(planes.data(), place.data()) == expected_behind);
            REQUIRE(lanes.near_way(spheres.data(), marked, way.data()) == expected_near);
        }
    }
    CHECK(behind > 100);
    CHECK(behind < 1900);
    CHECK(near > 10);
}
