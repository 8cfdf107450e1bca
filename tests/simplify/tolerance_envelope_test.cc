#include "hsdm/simplify/tolerance_envelope.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <array>

using namespace hsdm;

TEST_CASE("an envelope holds what is within its tolerance", "[simplify]") {
    PolygonMesh square;
    square.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
    square.add_facet(std::array<Index, 4>{0, 1, 2, 3});
    const SurfaceWalk surface(square);
    const ToleranceEnvelope envelope{surface, 0.5};
    support::Random random(1);
    Index hint = no_index;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 place(random.uniform(), random.uniform(), random.uniform());
        REQUIRE(envelope.holds(place, hint) == (place[2] <= 0.5));
    }
}
