#include "hsdm/normals/near_lanes.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <vector>

using namespace hsdm;

namespace {

struct Answer {
    std::size_t count = 0;
    std::vector<float> distance, near_distance;
    std::vector<Index> near;
};

Answer answer_of(const NearLanes& lanes, const std::array<std::vector<float>, 3>& axes, std::size_t size,
                 const std::array<float, 3>& point, float limit) {
    Answer found;
    found.distance.resize(size + NearLanes::most);
    found.near_distance.resize(size + 2 * NearLanes::most);
    found.near.resize(size + NearLanes::most);
    found.count = lanes.find({{axes[0].data(), axes[1].data(), axes[2].data()}, size}, point, limit,
                             {found.distance.data(), found.near.data(), found.near_distance.data()});
    found.distance.resize(size);
    std::fill(found.near_distance.begin() + static_cast<std::ptrdiff_t>(found.count),
              found.near_distance.end(), std::numeric_limits<float>::infinity());
    return found;
}

std::vector<Index> first_of(const std::vector<Index>& all, std::size_t count) {
    return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)};
}

} // namespace

TEST_CASE("lanes of every width find, count and keep the same candidates", "[normals]") {
    support::Random random(9);
    const auto any = [&] { return static_cast<float>(random.uniform(-1, 1)); };
    std::size_t most = 0;
    for (std::size_t size = 0; size < 300; ++size) {
        std::array<std::vector<float>, 3> axes;
        for (std::vector<float>& axis : axes) {
            axis.resize(size + NearLanes::most, 0.0f); // what follows is near, and no candidate
            std::generate(axis.begin(), axis.begin() + static_cast<std::ptrdiff_t>(size), any);
        }
        if (size > 3) axes[1][3] = std::numeric_limits<float>::quiet_NaN();
        const std::array<float, 3> point{any() / 4, any() / 4, any() / 4};
        // a limit that one distance is equal to
        float limit = 0.3f;
        if (size > 0) {
            const Answer all = answer_of(near_lanes().back(), axes, size, point, limit);
            limit = all.distance.back();
            CHECK(all.count == static_cast<std::size_t>(std::ranges::count_if(all.distance, [](float d) {
                      return d <= 0.3f;
                  })));
        }
        const Answer expected = answer_of(near_lanes().back(), axes, size, point, limit);
        REQUIRE(std::ranges::is_sorted(first_of(expected.near, expected.count)));
        most = std::max(most, expected.count);
        std::vector<Index> expected_kept = expected.near;
        const std::size_t kept = near_lanes().back().keep(expected.near_distance.data(), expected.count,
                                                          limit / 2, expected_kept.data());
        for (const NearLanes& lanes : near_lanes()) {
            const Answer found = answer_of(lanes, axes, size, point, limit);
            REQUIRE(found.count == expected.count);
            REQUIRE(first_of(found.near, found.count) == first_of(expected.near, expected.count));
            REQUIRE(found.near_distance == expected.near_distance);
            REQUIRE(std::ranges::equal(found.distance, expected.distance,
                                       [](float a, float b) { return a == b || (a != a && b != b); }));
            REQUIRE(lanes.count(found.near_distance.data(), found.count, limit / 2) == kept);
            std::vector<Index> near = found.near;
            REQUIRE(lanes.keep(found.near_distance.data(), found.count, limit / 2, near.data()) == kept);
            REQUIRE(first_of(near, kept) == first_of(expected_kept, kept));
        }
    }
    CHECK(most > 50);
}
