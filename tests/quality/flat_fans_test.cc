#include "hsdm/quality/flat_fans.hh"
#include "hsdm/quality/triangles_meet.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

using namespace hsdm;

namespace {

/// Triangles round the first of some positions.
struct FanMesh {
    std::vector<Vec3> positions;
    std::vector<Triangle> triangles;

    bool is_flat() const {
        std::vector<Index> own(positions.size());
        std::iota(own.begin(), own.end(), 0);
        return flat_fans(positions, triangles, own)[0] != 0;
    }
    bool meets_itself() const {
        const auto place = [&](const Triangle& t) {
            return PlacedTriangle{{positions[t[0]], positions[t[1]], positions[t[2]]}, {t[0], t[1], t[2]}};
        };
        for (std::size_t i = 0; i < triangles.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (triangles_meet(place(triangles[i]), place(triangles[j]))) return true;
        return false;
    }
};

/// Spokes that go round so many times, with heights and lengths at random; closed by the last triangle.
FanMesh round_fan(std::size_t spokes, double times, double roughness, std::mt19937_64& random) {
    std::uniform_real_distribution<double> either_way(-roughness, roughness), length(0.2, 1);
    FanMesh fan;
    fan.positions.emplace_back(0, 0, 0);
    for (std::size_t i = 0; i < spokes; ++i) {
        const double angle =
            2 * std::numbers::pi * times * static_cast<double>(i) / static_cast<double>(spokes)
            + 0.3 * either_way(random);
        fan.positions.push_back(length(random) * Vec3(std::cos(angle), std::sin(angle), either_way(random)));
    }
    for (Index i = 0; i < spokes; ++i)
        fan.triangles.push_back({0, i + 1, (i + 1) % static_cast<Index>(spokes) + 1});
    return fan;
}

} // namespace

TEST_CASE("triangles of a flat fan never meet beside what they share", "[flat_fans]") {
    std::mt19937_64 random(1);
    std::uniform_int_distribution<std::size_t> spokes(3, 9);
    std::uniform_real_distribution<double> roughness(0, 3);
    std::size_t flat = 0, wrong = 0, meeting = 0;
    for (int i = 0; i < 4000; ++i) {
        FanMesh fan = round_fan(spokes(random), 1 + i % 2, roughness(random), random);
        if (i % 5 == 0) std::swap(fan.triangles[0][1], fan.triangles[0][2]); // one faces the other way
        if (i % 7 == 0) fan.triangles.push_back(fan.triangles[1]);
        const bool meets = fan.meets_itself(), is_flat = fan.is_flat();
        flat += is_flat;
        meeting += meets;
        wrong += is_flat && meets;
    }
    CHECK(wrong == 0);
    CHECK(flat > 500);
    CHECK(meeting > 500);
}

TEST_CASE("a fan is flat whole, turned once, and all one way", "[flat_fans]") {
    std::mt19937_64 random(2);
    for (std::size_t spokes : {3u, 4u, 6u, 9u}) {
        FanMesh fan = round_fan(spokes, 1, 0.1, random);
        CHECK(fan.is_flat());
        std::swap(fan.triangles[0][1], fan.triangles[0][2]);
        CHECK_FALSE(fan.is_flat());
        fan.triangles.erase(fan.triangles.begin());
        CHECK_FALSE(fan.is_flat()); // open: it might go round farther than seen
        CHECK_FALSE(round_fan(2 * spokes + 1, 2, 0.1, random).is_flat());
    }
    FanMesh needle = round_fan(4, 1, 0, random);
    needle.positions[2] = needle.positions[1] * 0.5;
    CHECK_FALSE(needle.is_flat());
}
