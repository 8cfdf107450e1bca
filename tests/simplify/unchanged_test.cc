#include "hsdm/simplify/unchanged.hh"

#include <catch2/catch.hpp>

#include <array>

using namespace hsdm;

namespace {

/// A pentagon, a quad and two triangles.
PolygonMesh some_mesh() {
    PolygonMesh mesh;
    for (int v = 0; v < 9; ++v) mesh.positions.emplace_back(v, v * v, v % 3);
    mesh.add_facet(std::array<Index, 5>{0, 1, 2, 3, 4});
    mesh.add_facet(std::array<Index, 4>{3, 2, 5, 6});
    mesh.add_facet(std::array<Index, 3>{6, 5, 7});
    mesh.add_facet(std::array<Index, 3>{7, 5, 8});
    return mesh;
}

/// The same with vertex and facet numbers the other way round.
PolygonMesh renumbered(const PolygonMesh& mesh) {
    PolygonMesh result;
    const auto last = static_cast<Index>(mesh.vertex_count() - 1);
    for (Index v = last + 1; v-- > 0;) {
        result.positions.push_back(mesh.positions[v]);
        result.origin.push_back(v);
    }
    for (std::size_t f = mesh.facet_count(); f-- > 0;) {
        std::vector<Index> ring;
        for (Index v : mesh.facet(f)) ring.push_back(last - v);
        result.add_facet(ring);
    }
    return result;
}

} // namespace

TEST_CASE("all of a mesh is unchanged under other numbers", "[simplify]") {
    const PolygonMesh mesh = some_mesh(), other = renumbered(mesh);
    const Unchanged same = find_unchanged(mesh, other);
    CHECK(same.vertex == std::vector<Index>{8, 7, 6, 5, 4, 3, 2, 1, 0});
    CHECK(same.vertex_now == same.vertex);
    CHECK(same.facet == std::vector<Index>{3, 2, 1, 0});
    CHECK(same.facet_now == same.facet);
}

TEST_CASE("a vertex that moved has changed, and so have its facets", "[simplify]") {
    const PolygonMesh mesh = some_mesh();
    PolygonMesh moved = mesh;
    moved.positions[6] += Vec3(0, 0, 1e-12);
    const Unchanged same = find_unchanged(mesh, moved);
    CHECK(same.vertex[6] == no_index);
    CHECK(same.vertex[5] == 5);
    CHECK(same.facet == std::vector<Index>{0, no_index, no_index, 3});
    CHECK(same.facet_now == same.facet);
}

TEST_CASE("a triangle may begin anywhere, a larger facet is another one then", "[simplify]") {
    const PolygonMesh mesh = some_mesh();
    PolygonMesh turned;
    turned.positions = mesh.positions;
    turned.add_facet(std::array<Index, 5>{1, 2, 3, 4, 0});
    turned.add_facet(std::array<Index, 4>{3, 2, 5, 6});
    turned.add_facet(std::array<Index, 3>{5, 7, 6});
    turned.add_facet(std::array<Index, 3>{5, 7, 8}); // the other way round
    CHECK(find_unchanged(mesh, turned).facet == std::vector<Index>{no_index, 1, 2, no_index});
}

TEST_CASE("of two facets with one ring only the first is unchanged", "[simplify]") {
    const PolygonMesh mesh = some_mesh();
    PolygonMesh twice = mesh;
    twice.add_facet(std::array<Index, 3>{5, 7, 6});
    CHECK(find_unchanged(mesh, twice).facet == std::vector<Index>{0, 1, 2, 3, no_index});
    CHECK(find_unchanged(mesh, {}).facet_now == std::vector<Index>(4, no_index));
    CHECK(find_unchanged({}, mesh).facet == std::vector<Index>(4, no_index));
}
