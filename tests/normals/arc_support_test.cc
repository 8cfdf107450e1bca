#include "hsdm/normals/arc_support.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace hsdm;

namespace {

/// Neighbours on a cylinder of which the origin is a point, and one normal more than there are neighbours.
std::pair<ArcNeighbors, ArcCandidates> on_cylinder(support::Random& random, double radius,
                                                   std::size_t count) {
    ArcNeighbors around;
    around.count = count;
    around.inverse_tolerance = 1 / random.uniform(0.05, 0.2);
    ArcCandidates candidates;
    candidates.add({0, 0, 1});
    for (std::size_t k = 0; k < count; ++k) {
        const double turn = random.uniform(-1, 1);
        const Vec3 normal(std::sin(turn), 0, std::cos(turn));
        around.normals[k] = normal;
        around.offsets[k] = normal * radius - Vec3(0, random.uniform(-1, 1), radius);
        around.rises[k] = around.normals[k] | around.offsets[k];
        candidates.add((Vec3(0, 0, 1) + random.direction() * random.uniform(0, 2)).normalized());
    }
    return {around, candidates};
}

} // namespace

TEST_CASE("arcs explain all neighbours on a cylinder, planes those beside its ruling", "[normals]") {
    support::Random random(3);
    for (const std::size_t count : {1u, 5u, 16u, 64u}) {
        auto [around, candidates] = on_cylinder(random, 2, count);
        ArcSupport support;
        support_by_arcs(around, candidates, support);
        double cosines = 0;
        for (std::size_t j = 0; j < count; ++j) cosines += candidates[0] | around.normals[j];
        CHECK(support.arc[0] == Approx(cosines));
        for (std::size_t k = 0; k < candidates.count; ++k) {
            double plane = 0, arc = 0;
            for (std::size_t j = 0; j < count; ++j) {
                const double cosine = std::max(0.0, candidates[k] | around.normals[j]);
                const double rise = candidates[k] | around.offsets[j];
                const double off = rise * around.inverse_tolerance;
                const double bend = (rise + around.rises[j]) * around.inverse_tolerance;
                plane += cosine * std::pow(std::max(0.0, 1 - off * off), 2);
                arc += cosine * std::pow(std::max(0.0, 1 - bend * bend / (2 + 2 * cosine)), 2);
            }
            CHECK(support.plane[k] == Approx(plane).margin(1e-12));
            CHECK(support.arc[k] == Approx(arc).margin(1e-12));
        }
    }
}

TEST_CASE("lanes of every width give arcs the same support, to the last bit", "[normals]") {
    support::Random random(5);
    double most = 0;
    for (int round = 0; round < 500; ++round) {
        auto [around, candidates] =
            on_cylinder(random, random.uniform(1, 4), 1 + static_cast<std::size_t>(round) % 64);
        ArcSupport expected;
        support_by_arcs(around, candidates, expected); // fills up the rows
        for (const ArcLanes lanes : arc_lanes()) {
            ArcSupport same;
            lanes(around, candidates, same);
            const auto count = static_cast<std::ptrdiff_t>(candidates.count);
            REQUIRE(std::equal(same.plane.begin(), same.plane.begin() + count, expected.plane.begin()));
            REQUIRE(std::equal(same.arc.begin(), same.arc.begin() + count, expected.arc.begin()));
        }
        most = std::max(most, expected.arc[1]);
    }
    CHECK(most > 1);
}
