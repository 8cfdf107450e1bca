#include "hsdm/core/chunks.hh"
#include "hsdm/simplify/tolerance_envelope.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <array>

using namespace hsdm;

TEST_CASE("an envelope holds what is within its tolerance, whoever asks and in any order", "[simplify]") {
    PolygonMesh square;
    square.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
    square.add_facet(std::array<Index, 4>{0, 1, 2, 3});
    const SurfaceWalk surface(square);
    const ToleranceEnvelope envelope{surface, 0.5};
    support::Random random(1);
    std::vector<Vec3> places;
    for (int i = 0; i < 2000; ++i) places.emplace_back(random.uniform(), random.uniform(), random.uniform());
    std::vector<std::uint8_t> held(places.size());
    for_chunks(held.size(), 50, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        Index hint = no_index;
        for (std::size_t i = begin; i < end; ++i) { // every other chunk asks for the first places too
            held[i] = envelope.holds(places[i], hint);
            if (chunk % 2 == 1) envelope.holds(places[i - begin], hint);
        }
    });
    for (std::size_t i = 0; i < held.size(); ++i) REQUIRE(held[i] == (places[i][2] <= 0.5));
}
