#include "hsdm/mesh/debris.hh"

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

/// A closed box of six quads beside the mesh.
void add_box(PolygonMesh& mesh) {
    const auto base = static_cast<Index>(mesh.vertex_count());
    for (unsigned k = 0; k < 8; ++k) mesh.positions.emplace_back(k & 1, k >> 1 & 1, base + (k >> 2));
    for (const std::array<Index, 4>& q : {std::array<Index, 4>{0, 2, 3, 1},
                                          {0, 1, 5, 4},
                                          {1, 3, 7, 5},
                                          {3, 2, 6, 7},
                                          {2, 0, 4, 6},
                                          {4, 5, 7, 6}})
        mesh.add_facet(std::array{base + q[0], base + q[1], base + q[2], base + q[3]});
}

TEST_CASE("splinters beside a large surface are dropped, small parts are not", "[mesh]") {
    PolygonMesh mesh;
    add_strip(mesh, 32);
    add_strip(mesh, 1100);
    add_strip(mesh, 33);
    add_strip(mesh, 1);
    add_box(mesh);
    CHECK(drop_debris(mesh, {.most_facets = 5, .most_open = 32, .least_ratio = 32}).count == 33);
    CHECK(mesh.facet_count() == 1139);
    CHECK(drop_debris(mesh).count == 6);
    CHECK(drop_debris(mesh).count == 0);
}

TEST_CASE("a few facets are no debris where all components are small", "[mesh]") {
    PolygonMesh mesh;
    add_strip(mesh, 4);
    add_strip(mesh, 120);
    CHECK(drop_debris(mesh).count == 0);
    CHECK(drop_debris(mesh, {.most_facets = 12, .most_open = 32, .least_ratio = 25}).count == 4);
    PolygonMesh none;
    CHECK(drop_debris(none).count == 0);
}
