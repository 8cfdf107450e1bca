#include "hsdm/quality/flat_fans.hh"
#include "hsdm/quality/triangles_meet.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

using namespace hsdm;

namespace {

/// Facets round the first of some positions.
struct FanMesh {
    PolygonMesh mesh;

    bool is_flat() const {
        std::vector<Index> own(mesh.vertex_count());
        std::iota(own.begin(), own.end(), Index{0});
        return flat_fans(mesh, own)[0] != 0;
    }
    /// Whichever way quads are cut.
    bool meets_itself() const { return meets_itself(0) || meets_itself(1); }
    void turn(std::size_t facet) {
        std::reverse(mesh.corners.begin() + mesh.first[facet], mesh.corners.begin() + mesh.first[facet + 1]);
    }

private:
    bool meets_itself(std::size_t cut) const {
        std::vector<PlacedTriangle> triangles;
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
            const auto facet = mesh.facet(f);
            for (std::size_t i = 1; i + 1 < facet.size(); ++i) {
                PlacedTriangle t;
                for (std::size_t k = 0; k < 3; ++k) {
                    t.vertex[k] = facet[(cut + (k == 0 ? 0 : i + k - 1)) % facet.size()];
                    t.corner[k] = mesh.positions[t.vertex[k]];
                }
                triangles.push_back(t);
            }
        }
        for (std::size_t i = 0; i < triangles.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (triangles_meet(triangles[i], triangles[j])) return true;
        return false;
    }
};

/// Spokes that go round so many times, with heights and lengths at random; closed by the last facet. A share
/// of the facets are quads.
FanMesh round_fan(std::size_t spokes, double times, double roughness, double quads, std::mt19937_64& random) {
    std::uniform_real_distribution<double> either_way(-roughness, roughness), length(0.2, 1);
    FanMesh fan;
    const auto place = [&](double at) {
        const double angle =
            2 * std::numbers::pi * times * at / static_cast<double>(spokes) + 0.3 * either_way(random);
        return length(random) * Vec3(std::cos(angle), std::sin(angle), either_way(random));
    };
    fan.mesh.positions.emplace_back(0, 0, 0);
    for (std::size_t i = 0; i < spokes; ++i) fan.mesh.positions.push_back(place(static_cast<double>(i)));
    for (Index i = 0; i < spokes; ++i) {
        const Index one = i + 1, next = (i + 1) % static_cast<Index>(spokes) + 1;
        if (length(random) < 0.2 + 0.8 * quads) {
            fan.mesh.positions.push_back(2 * place(i + 0.5));
            fan.mesh.add_facet(
                std::array{Index{0}, one, static_cast<Index>(fan.mesh.vertex_count() - 1), next});
        } else {
            fan.mesh.add_facet(std::array{Index{0}, one, next});
        }
    }
    return fan;
}

} // namespace

TEST_CASE("facets of a flat fan never meet beside what they share, however they are cut", "[flat_fans]") {
    std::mt19937_64 random(1);
    std::uniform_int_distribution<std::size_t> spokes(3, 9);
    std::uniform_real_distribution<double> roughness(0, 3);
    std::size_t flat = 0, wrong = 0, meeting = 0;
    for (int i = 0; i < 6000; ++i) {
        FanMesh fan = round_fan(spokes(random), 1 + i % 2, roughness(random), 0.5 * (i % 3), random);
        if (i % 5 == 0) fan.turn(0); // faces the other way
        if (i % 7 == 0)
            fan.mesh.add_facet(std::vector<Index>(fan.mesh.facet(1).begin(), fan.mesh.facet(1).end()));
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
        FanMesh fan = round_fan(spokes, 1, 0.1, 0, random);
        CHECK(fan.is_flat());
        fan.turn(0);
        CHECK_FALSE(fan.is_flat());
        FanMesh open;
        open.mesh.positions = fan.mesh.positions;
        for (std::size_t f = 1; f < spokes; ++f) open.mesh.add_facet(fan.mesh.facet(f));
        CHECK_FALSE(open.is_flat()); // it might go round farther than seen
        CHECK_FALSE(round_fan(2 * spokes + 1, 2, 0.1, 0, random).is_flat());
    }
    FanMesh needle = round_fan(4, 1, 0, 0, random);
    needle.mesh.positions[2] = needle.mesh.positions[1] * 0.5;
    CHECK_FALSE(needle.is_flat());
}

TEST_CASE("quads round a vertex are flat if they are convex as it sees them", "[flat_fans]") {
    FanMesh fan;
    fan.mesh.positions = {{0, 0, 0},  {1, 0, 0},   {1, 1, 0.2},   {0, 1, 0}, {-1, 1, 0},
                          {-1, 0, 0}, {-1, -1, 0}, {0, -1, -0.1}, {1, -1, 0}};
    for (Index i = 1; i < 8; i += 2)
        fan.mesh.add_facet(std::array{Index{0}, i, i + 1, i + 2 > 8 ? 1 : i + 2});
    CHECK(fan.is_flat());
    fan.mesh.positions[2] = {0.4, 0.4, 0}; // a dart: cut the other way it is folded
    CHECK_FALSE(fan.is_flat());
    fan.mesh.positions[2] = {1, -0.2, 0}; // beyond its sector
    CHECK_FALSE(fan.is_flat());
}
