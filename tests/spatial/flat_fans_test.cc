#include "hsdm/spatial/flat_fans.hh"
#include "hsdm/spatial/triangles_meet.hh"

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
    /// Whichever triangles facets are cut into: any three corners of one against any of another, and the two
    /// cuts of a quad.
    bool meets_itself() const {
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
            if (mesh.facet(f).size() == 4)
                for (std::size_t cut : {0u, 1u})
                    if (triangles_meet(corners(f, cut, cut + 1, cut + 2), corners(f, cut, cut + 2, cut + 3)))
                        return true;
            for (std::size_t g = 0; g < f; ++g)
                if (meet(f, g)) return true;
        }
        return false;
    }
    void turn(std::size_t facet) {
        std::reverse(mesh.corners.begin() + mesh.first[facet], mesh.corners.begin() + mesh.first[facet + 1]);
    }

private:
    PlacedTriangle corners(std::size_t f, std::size_t a, std::size_t b, std::size_t c) const {
        const auto facet = mesh.facet(f);
        PlacedTriangle t;
        t.vertex = {facet[a % facet.size()], facet[b % facet.size()], facet[c % facet.size()]};
        for (std::size_t k = 0; k < 3; ++k) t.corner[k] = mesh.positions[t.vertex[k]];
        return t;
    }
    std::vector<PlacedTriangle> triangles_of(std::size_t f) const {
        std::vector<PlacedTriangle> triangles;
        const std::size_t n = mesh.facet(f).size();
        for (std::size_t a = 0; a < n; ++a)
            for (std::size_t b = a + 1; b < n; ++b)
                for (std::size_t c = b + 1; c < n; ++c) triangles.push_back(corners(f, a, b, c));
        return triangles;
    }
    bool meet(std::size_t f, std::size_t g) const {
        for (const PlacedTriangle& t : triangles_of(f))
            for (const PlacedTriangle& u : triangles_of(g))
                if (triangles_meet(t, u)) return true;
        return false;
    }
};

/// Spokes that go round so many times, with heights and lengths at random; closed by the last facet. Facets
/// have up to so many corners between their spokes, now and then far out of their sectors.
FanMesh round_fan(std::size_t spokes, double times, double roughness, int between, std::mt19937_64& random) {
    std::uniform_real_distribution<double> either_way(-roughness, roughness), length(0.2, 1), any(0, 1);
    std::uniform_int_distribution<int> how_many(0, between);
    FanMesh fan;
    const auto place = [&](double at) {
        const double angle =
            2 * std::numbers::pi * times * at / static_cast<double>(spokes) + 0.3 * either_way(random);
        return length(random) * Vec3(std::cos(angle), std::sin(angle), either_way(random));
    };
    fan.mesh.positions.emplace_back(0, 0, 0);
    for (std::size_t i = 0; i < spokes; ++i) fan.mesh.positions.push_back(place(static_cast<double>(i)));
    for (Index i = 0; i < spokes; ++i) {
        std::vector<Index> facet{0, i + 1};
        const int corners = how_many(random);
        const double far = any(random) < 0.2 ? static_cast<double>(spokes) : 1;
        for (int k = 0; k < corners; ++k) {
            facet.push_back(static_cast<Index>(fan.mesh.vertex_count()));
            fan.mesh.positions.push_back(2 * place(i + far * (k + 1) / (corners + 1)));
        }
        facet.push_back((i + 1) % static_cast<Index>(spokes) + 1);
        fan.mesh.add_facet(facet);
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
        FanMesh fan = round_fan(spokes(random), 1 + i % 2, roughness(random), i % 4, random);
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

TEST_CASE("a pentagon that winds round a vertex by itself is in no flat fan", "[flat_fans]") {
    FanMesh fan;
    fan.mesh.positions.emplace_back(0, 0, 0);
    for (const double degrees : {0.0, 130.0, 270.0, 60.0, 180.0, 300.0}) {
        const double angle = degrees * std::numbers::pi / 180;
        fan.mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0);
    }
    fan.mesh.add_facet(std::array<Index, 5>{0, 1, 2, 3, 4}); // ends 60 degrees from where it begins
    for (const auto& [a, b] : {std::pair<Index, Index>{4, 5}, {5, 6}, {6, 1}})
        fan.mesh.add_facet(std::array{Index{0}, a, b});
    CHECK(fan.meets_itself());
    CHECK_FALSE(fan.is_flat());
}
