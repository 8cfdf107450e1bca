#include "hsdm/contour/middle_discs.hh"
#include "hsdm/core/constants.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <array>

using namespace hsdm;

namespace {

/// The same question, of one disc after the other.
bool part_one_by_one(const std::vector<MiddleDisc>& discs, const Vec3& p, const Vec3& q, const Vec3& normal) {
    std::array<std::array<bool, 2>, 2> seen{};
    for (const MiddleDisc& disc : discs) {
        if (std::abs(normal | disc.normal) > angles::halfway) continue;
        const double dp = disc.normal | (p - disc.middle), dq = disc.normal | (q - disc.middle);
        if ((dp < 0) == (dq < 0)) continue;
        const Vec3 x = p + (q - p) * (dp / (dp - dq));
        if ((x - disc.middle).sqrnorm() > disc.squared_radius) continue;
        if (((normal | (disc.point - x)) < 0) == disc.is_gap) seen[disc.is_gap][dp < 0] = true;
    }
    return (seen[0][0] && seen[0][1]) || (seen[1][0] && seen[1][1]);
}

Vec3 within(support::Random& random, double most) {
    const double x = random.uniform(-most, most), y = random.uniform(-most, most);
    return {x, y, random.uniform(-most, most)};
}

} // namespace

TEST_CASE("discs part the places that they part one by one, in any unit and anywhere", "[contour]") {
    for (const double voxel : {1.0, 0x1p-40, 0x1p60})
        for (const std::size_t count : {0u, 1u, 63u, 64u, 65u, 300u}) {
            support::Random random(7);
            const Vec3 amid = within(random, 1000 * voxel);
            std::vector<Vec3> places, normals;
            for (int i = 0; i < 20; ++i) places.push_back(amid + within(random, 1.5 * voxel));
            for (int i = 0; i < 8; ++i) normals.push_back(random.direction());
            MiddleDiscs discs;
            std::vector<MiddleDisc> all;
            for (int twice = 0; twice < 2; ++twice) { // what is known of the first ones is forgotten
                discs.reset(places, normals.size(), amid, voxel);
                all.clear();
                for (std::size_t d = 0; d < count; ++d) {
                    const Vec3 middle = amid + within(random, 1.5 * voxel);
                    const double radius = (0.6 + random.uniform(-0.4, 0.4)) * voxel;
                    all.push_back({middle, random.direction(), middle + within(random, voxel),
                                   radius * radius, random.uniform(-1, 1) > 0});
                    discs.add({&all.back(), 1});
                }
            }
            std::size_t parted = 0, standing = 0;
            for (std::size_t n = 0; n < normals.size(); ++n) {
                standing += discs.stand_on({n, normals[n]});
                const std::array surface{MiddleDiscs::Surface{n, normals[n]}};
                for (std::size_t p = 0; p < places.size(); ++p)
                    for (std::size_t q = 0; q < places.size(); ++q) {
                        const bool expected = part_one_by_one(all, places[p], places[q], normals[n]);
                        parted += expected;
                        REQUIRE(discs.part(p, q, surface) == expected);
                        const std::size_t m = (n + p + q) % normals.size();
                        const std::array surfaces{MiddleDiscs::Surface{n, normals[n]},
                                                  MiddleDiscs::Surface{m, normals[m]}};
                        REQUIRE(discs.part(p, q, surfaces)
                                == (expected || part_one_by_one(all, places[p], places[q], normals[m])));
                    }
            }
            if (count == 300) {
                CHECK(standing == normals.size());
                CHECK(parted > 100);
                CHECK(parted < normals.size() * places.size() * places.size());
            }
        }
}
