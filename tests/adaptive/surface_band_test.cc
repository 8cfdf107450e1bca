#include "hsdm/adaptive/surface_band.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <array>

using namespace hsdm;

TEST_CASE("a band holds the same places however often it is asked, with room for them or not", "[adaptive]") {
    PolygonMesh square;
    square.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
    square.add_facet(std::array<Index, 4>{0, 1, 2, 3});
    const MeshDistance surface(square);
    for (const std::size_t room : {std::size_t{0}, std::size_t{100}, std::size_t{10000}}) {
        INFO("room " << room);
        SurfaceBand band(surface, 0.5, room);
        for (int round = 0; round < 3; ++round) {
            support::Random random(1);
            Index hint = no_index;
            for (int i = 0; i < 2000; ++i) {
                const Vec3 place(random.uniform(), random.uniform(), random.uniform());
                REQUIRE(band.holds(place, hint) == (place[2] <= 0.5));
            }
        }
    }
}
