#include "hsdm/mesh/edge_table.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <map>

using namespace hsdm;

namespace {

/// The two vertices of an edge, the lower one first, and the sides on it.
using Edges = std::map<std::pair<Index, Index>, std::vector<Index>>;

/// Facets of three to five vertices out of so many, each among neighbours of its first.
PolygonMesh soup(Index vertices, std::size_t facets) {
    support::Random random(vertices);
    PolygonMesh mesh;
    mesh.positions.assign(vertices, Vec3(0, 0, 0));
    std::vector<Index> ring;
    while (mesh.facet_count() < facets) {
        ring.assign(1, static_cast<Index>(random.below(vertices)));
        const std::size_t size = 3 + random.below(3);
        while (ring.size() < size) {
            const Index v = (ring[0] + static_cast<Index>(random.below(8))) % vertices;
            if (std::find(ring.begin(), ring.end(), v) == ring.end()) ring.push_back(v);
        }
        mesh.add_facet(ring);
    }
    return mesh;
}

Edges edges_one_by_one(const PolygonMesh& mesh) {
    Edges edges;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto ring = mesh.facet(f);
        for (std::size_t i = 0; i < ring.size(); ++i)
            edges[std::minmax(ring[i], ring[(i + 1) % ring.size()])].push_back(mesh.first[f]
                                                                               + static_cast<Index>(i));
    }
    return edges;
}

/// The edges that a table visits, chunk after chunk.
std::vector<std::pair<std::pair<Index, Index>, std::vector<Index>>> visited(const EdgeTable& table) {
    std::vector<std::vector<std::pair<std::pair<Index, Index>, std::vector<Index>>>> parts(table.chunks());
    table.for_edges([&](Index lower, std::span<const EdgeSide> edge, std::size_t chunk) {
        std::vector<Index> sides;
        for (const EdgeSide& side : edge) {
            sides.push_back(side.side);
            if (side.upper != edge[0].upper) sides.push_back(no_index); // another edge's
        }
        parts[chunk].push_back({{lower, edge[0].upper}, sides});
    });
    return joined(parts);
}

} // namespace

TEST_CASE("an edge table has every edge once, in order, with all sides on it", "[mesh]") {
    for (const Index vertices : {8u, 1024u, 5000u}) { // of one chunk and of several
        INFO(vertices << " vertices");
        const PolygonMesh mesh = soup(vertices, 6000);
        const Edges expected = edges_one_by_one(mesh);
        const auto edges = visited(EdgeTable(mesh));
        CHECK(edges.size() == expected.size());
        CHECK(std::equal(
            edges.begin(), edges.end(), expected.begin(), expected.end(),
            [](const auto& a, const auto& b) { return a.first == b.first && a.second == b.second; }));
    }
}

TEST_CASE("an edge table does not depend on the number of threads", "[mesh]") {
    const PolygonMesh mesh = soup(40, 20000); // many sides to a vertex
    const auto many = visited(EdgeTable(mesh));
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    CHECK(visited(EdgeTable(mesh)) == many);
}

TEST_CASE("an edge table takes sides of any facets under the numbers they are given", "[mesh]") {
    const EdgeTable table(6, [](const auto& visit) {
        visit(4, 2, 70);
        visit(2, 4, 30);
        visit(0, 5, 10);
    });
    const auto edges = visited(table);
    REQUIRE(edges.size() == 2);
    CHECK(edges[0].first == std::pair<Index, Index>(0, 5));
    CHECK(edges[0].second == std::vector<Index>{10});
    CHECK(edges[1].first == std::pair<Index, Index>(2, 4));
    CHECK(edges[1].second == std::vector<Index>{30, 70});
    CHECK(visited(EdgeTable(PolygonMesh())).empty());
    PolygonMesh lonely; // a vertex without facets
    lonely.positions.emplace_back(0, 0, 0);
    CHECK(visited(EdgeTable(lonely)).empty());
}

TEST_CASE("from side to side one comes once round each facet", "[mesh]") {
    const PolygonMesh mesh = soup(200, 20000);
    const std::vector<Index> next = next_sides(mesh);
    REQUIRE(next.size() == mesh.corners.size());
    std::size_t wrong = 0;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        Index side = mesh.first[f];
        for (Index v : mesh.facet(f)) {
            wrong += mesh.corners[side] != v;
            side = next[side];
        }
        wrong += side != mesh.first[f];
    }
    CHECK(wrong == 0);
    CHECK(next_sides(PolygonMesh()).empty());
}
