#include "hsdm/normals/neighborhood.hh"
#include "hsdm/normals/plane_support.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace hsdm;

namespace {

/// Neighbours near a plane or two, of so many normals.
Planes random_planes(support::Random& random, std::size_t count) {
    Planes planes;
    planes.inverse_tolerance = 1 / random.uniform(0.05, 0.5);
    for (std::size_t k = 0; k < count; ++k) {
        const Vec3 normal =
            (Vec3(0, 0, k % 3 == 0 ? -1 : 1) + random.direction() * random.uniform(0, 1)).normalized();
        planes.add(normal, random.direction() - normal * random.uniform(0, 1));
    }
    return planes;
}

} // namespace

TEST_CASE("planes are supported by what is close to them, and of it by what agrees", "[normals]") {
    support::Random random(3);
    for (const std::size_t count : {1u, 5u, 16u, 64u}) {
        Planes planes = random_planes(random, count);
        Support near, agreeing;
        near_planes(planes, near);
        agreeing_with_planes(planes, agreeing);
        for (std::size_t k = 0; k < count; ++k) {
            const auto row = [k](const Planes::Rows& rows) {
                return Vec3(rows[0][k], rows[1][k], rows[2][k]);
            };
            const Vec3 normal = row(planes.normals);
            double all = 0, of_agreeing = 0;
            for (std::size_t j = 0; j < count; ++j) {
                const auto at = [j](const Planes::Rows& rows) {
                    return Vec3(rows[0][j], rows[1][j], rows[2][j]);
                };
                const double close = closeness(normal | at(planes.offsets), planes.inverse_tolerance);
                const double cosine = normal | at(planes.normals);
                all += close;
                if (cosine > 0) of_agreeing += agreement(cosine) * close;
            }
            CHECK(near[k] == Approx(all).margin(1e-12));
            CHECK(agreeing[k] == Approx(of_agreeing).margin(1e-12));
        }
    }
}

TEST_CASE("lanes of every width give planes the same support, to the last bit", "[normals]") {
    support::Random random(5);
    double most = 0;
    for (int round = 0; round < 500; ++round) {
        Planes planes = random_planes(random, 1 + static_cast<std::size_t>(round) % 64);
        Support near, agreeing;
        near_planes(planes, near); // fills up the rows
        agreeing_with_planes(planes, agreeing);
        for (const SupportLanes& lanes : support_lanes()) {
            Support same;
            const auto is_same = [&](const Support& expected) {
                return std::equal(same.begin(), same.begin() + static_cast<std::ptrdiff_t>(planes.count),
                                  expected.begin());
            };
            lanes.near(planes, same);
            REQUIRE(is_same(near));
            lanes.agreeing(planes, same);
            REQUIRE(is_same(agreeing));
        }
        most = std::max(most, agreeing[0]);
    }
    CHECK(most > 1);
}
