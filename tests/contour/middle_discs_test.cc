#include "hsdm/contour/middle_discs.hh"
#include "hsdm/core/constants.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>

using namespace hsdm;

namespace {

struct SeenSheet {
    Vec3 normal;
    std::vector<SeenDisc> discs;
};

/// The same question, of one disc after the other.
bool part_one_by_one(const std::vector<SeenSheet>& sheets, const Vec3& p, const Vec3& q, const Vec3& normal) {
    std::array<std::array<bool, 2>, 2> seen{};
    for (const SeenSheet& sheet : sheets)
        for (const SeenDisc& disc : sheet.discs) {
            if (std::abs(normal | sheet.normal) > angles::halfway) continue;
            const Vec3 middle = disc.point + sheet.normal * disc.off;
            const double dp = sheet.normal | (p - middle), dq = sheet.normal | (q - middle);
            if ((dp < 0) == (dq < 0)) continue;
            const Vec3 x = p + (q - p) * (dp / (dp - dq));
            if ((x - middle).sqrnorm() > disc.radius * disc.radius) continue;
            const bool is_gap = disc.off > 0;
            if (((normal | (disc.point - x)) < 0) == is_gap) seen[is_gap][dp < 0] = true;
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
            Box everywhere;
            for (const Vec3& place : places) everywhere.add(place);
            MiddleDiscs discs;
            std::vector<SeenSheet> all;
            for (int twice = 0; twice < 2; ++twice) { // what is known of the first ones is forgotten
                discs.reset(normals.size(), amid, voxel);
                all.clear();
                for (std::size_t d = 0; d < count; d += all.back().discs.size()) {
                    all.push_back({random.direction(), {}});
                    while (all.back().discs.size() < std::min<std::size_t>(count - d, 1 + all.size() % 5))
                        all.back().discs.push_back({amid + within(random, 1.5 * voxel),
                                                    random.uniform(-0.7, 0.7) * voxel,
                                                    (0.6 + random.uniform(-0.4, 0.4)) * voxel});
                }
                for (const SeenSheet& sheet : all) discs.add(sheet.normal, sheet.discs);
                discs.set_places(places);
            }
            std::size_t parted = 0, standing = 0;
            for (std::size_t n = 0; n < normals.size(); ++n) {
                standing += discs.stand_on({n, normals[n]});
                for (std::size_t p = 0; p < places.size(); ++p)
                    for (std::size_t q = 0; q < places.size(); ++q) {
                        const bool expected = part_one_by_one(all, places[p], places[q], normals[n]);
                        parted += expected;
                        const std::size_t m = (n + p + q) % normals.size();
                        Box way;
                        way.add(places[p]);
                        way.add(places[q]);
                        const std::array surfaces{MiddleDiscs::Surface{n, normals[n]},
                                                  MiddleDiscs::Surface{m, normals[m]}};
                        const auto part = [&](std::size_t asked, const Box& box) {
                            return discs.look_at(std::span(surfaces).first(asked), box) && discs.part(p, q);
                        };
                        REQUIRE(part(1, way) == expected);
                        REQUIRE(part(2, everywhere)
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
