#include "hsdm/facets/debris.hh"

#include <catch2/catch.hpp>

#include <array>

using namespace hsdm;

namespace {

/// A strip of n quads beside the mesh.
void add_strip(PolygonMesh& mesh, Index n) {
    const auto base = static_cast<Index>(mesh.vertex_count());
    for (Index i = 0; i <= n; ++i) {
        mesh.positions.emplace_back(i, 0, base);
        mesh.positions.emplace_back(i, 1, base);
    }
    for (Index i = 0; i < n; ++i)
        mesh.add_facet(std::array{base + 2 * i, base + 2 * i + 2, base + 2 * i + 3, base + 2 * i + 1});
}

} // namespace

TEST_CASE("splinters beside a large surface are dropped, small parts are not", "[facets]") {
    PolygonMesh mesh;
    add_strip(mesh, 12);
    add_strip(mesh, 800);
    add_strip(mesh, 13);
    add_strip(mesh, 1);
    CHECK(drop_debris(mesh) == 13);
    CHECK(mesh.facet_count() == 813);
    CHECK(drop_debris(mesh) == 0);
}

TEST_CASE("a few facets are no debris where all components are small", "[facets]") {
    PolygonMesh mesh;
    add_strip(mesh, 4);
    add_strip(mesh, 200);
    CHECK(drop_debris(mesh) == 0);
    CHECK(drop_debris(mesh, {.most_facets = 8, .least_ratio = 50}) == 4);
    PolygonMesh none;
    CHECK(drop_debris(none) == 0);
}
