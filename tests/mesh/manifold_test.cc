#include "hsdm/mesh/manifold.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <map>
#include <random>
#include <set>

using namespace hsdm;
using support::mesh_of;

namespace {

using Facets = std::vector<std::vector<Index>>;

/// Checks from the definition, by maps: nothing here is shared with the code under test.
std::string manifold_fault(const PolygonMesh& mesh) {
    std::map<std::pair<Index, Index>, int> ways;
    std::map<Index, std::map<Index, Index>> link; // vertex -> the edge path across its facets
    std::set<std::vector<Index>> seen;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto facet = mesh.facet(f);
        std::vector<Index> sorted(facet.begin(), facet.end());
        std::sort(sorted.begin(), sorted.end());
        if (sorted.size() < 3 || std::unique(sorted.begin(), sorted.end()) != sorted.end())
            return "degenerate facet";
        if (!seen.insert(sorted).second) return "duplicate facet";
        for (std::size_t i = 0; i < facet.size(); ++i) {
            const Index a = facet[(i + facet.size() - 1) % facet.size()], v = facet[i],
                        b = facet[(i + 1) % facet.size()];
            if (++ways[{v, b}] > 1) return "edge used twice in one direction";
            if (!link[v].emplace(b, a).second) return "link branches";
        }
    }
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        const auto& steps = link[v];
        if (steps.empty()) return "isolated vertex";
        // Start where the fan begins, if it has a beginning, and follow it: it must visit every facet.
        std::set<Index> ends;
        for (auto [from, to] : steps) ends.insert(to);
        Index at = steps.begin()->first;
        for (auto [from, to] : steps)
            if (!ends.count(from)) at = from;
        const Index begin = at;
        std::size_t visited = 0;
        for (auto step = steps.find(at); step != steps.end(); step = steps.find(at)) {
            ++visited;
            at = step->second;
            if (at == begin) break;
        }
        if (visited != steps.size()) return "vertex with several fans";
    }
    return "";
}

std::size_t boundary_edges(const PolygonMesh& mesh) {
    std::set<std::pair<Index, Index>> half_edges;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto facet = mesh.facet(f);
        for (std::size_t i = 0; i < facet.size(); ++i)
            half_edges.insert({facet[i], facet[(i + 1) % facet.size()]});
    }
    return static_cast<std::size_t>(std::count_if(half_edges.begin(), half_edges.end(), [&](auto h) {
        return !half_edges.count({h.second, h.first});
    }));
}

/// The boundary of a set of cells of a grid, facets outward: closed, and non-manifold wherever cells touch in
/// an edge or a corner only.
PolygonMesh boundary_of_cells(const std::set<std::array<int, 3>>& cells) {
    PolygonMesh mesh;
    std::map<std::array<int, 3>, Index> vertex;
    auto corner = [&](std::array<int, 3> c) {
        auto [at, added] = vertex.emplace(c, static_cast<Index>(mesh.vertex_count()));
        if (added) mesh.positions.emplace_back(c[0], c[1], c[2]);
        return at->second;
    };
    for (const auto& cell : cells)
        for (unsigned axis = 0; axis < 3; ++axis)
            for (int side : {-1, 1}) {
                auto beyond = cell;
                beyond[axis] += side;
                if (cells.count(beyond)) continue;
                std::array<Index, 4> quad;
                for (unsigned i = 0; i < 4; ++i) {
                    auto c = cell;
                    c[axis] += side > 0;
                    c[(axis + 1) % 3] += i == 1 || i == 2;
                    c[(axis + 2) % 3] += i >= 2;
                    quad[side > 0 ? i : 3 - i] = corner(c);
                }
                mesh.add_facet(quad);
            }
    return mesh;
}

double volume_of(const PolygonMesh& mesh) {
    double volume = 0;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto facet = mesh.facet(f);
        for (std::size_t i = 1; i + 1 < facet.size(); ++i)
            volume +=
                (mesh.positions[facet[0]] | (mesh.positions[facet[i]] % mesh.positions[facet[i + 1]])) / 6;
    }
    return volume;
}

} // namespace

TEST_CASE("sharp edges keep their ends where vertices before them go, and go with their ends", "[manifold]") {
    PolygonMesh mesh = mesh_of({{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {8, 8, 8}, {0, 1, 0}}, {{1, 2, 4}});
    mesh.sharp_edges = {{0, 1}, {1, 2}, {1, 4}, {2, 3}};
    CHECK(remove_isolated_vertices(mesh) == 2);
    CHECK(mesh.sharp_edges == std::vector<std::array<Index, 2>>{{0, 1}, {0, 2}});
}

TEST_CASE("a manifold mesh is left as it is", "[manifold]") {
    PolygonMesh cube = boundary_of_cells({{0, 0, 0}});
    const PolygonMesh before = cube;
    const ManifoldCounts counts = make_manifold(cube);
    CHECK_FALSE(counts.changed());
    CHECK(is_manifold(cube, link_facets(cube)));
    CHECK(cube.corners == before.corners);
    CHECK(cube.positions == before.positions);
    CHECK(manifold_fault(cube) == "");
}

TEST_CASE("opposite facets over the same vertices cancel and equal ones stay once", "[manifold]") {
    const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    PolygonMesh pillow = mesh_of(corners, {{0, 1, 2, 3}, {2, 1, 0, 3}});
    CHECK(make_manifold(pillow).cancelled == 2);
    CHECK(pillow.facet_count() == 0);
    CHECK(pillow.vertex_count() == 0);

    PolygonMesh pile = mesh_of(corners, {{0, 1, 2, 3}, {1, 2, 3, 0}, {3, 2, 1, 0}, {2, 3, 0, 1}});
    const ManifoldCounts counts = make_manifold(pile);
    CHECK(counts.cancelled == 2);
    CHECK(counts.duplicates == 1);
    REQUIRE(pile.facet_count() == 1);
    CHECK(manifold_fault(pile) == "");
}

TEST_CASE("facets that touch themselves are cut there", "[manifold]") {
    const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
    PolygonMesh eight = mesh_of(corners, {{0, 1, 2, 0, 3, 4}, {1, 1, 2}, {3, 4, 3}});
    const ManifoldCounts counts = make_manifold(eight);
    CHECK(counts.degenerate == 2);
    CHECK(eight.facet_count() == 2);
    CHECK(manifold_fault(eight) == "");
}

TEST_CASE("cubes that touch in a vertex or an edge are parted and stay closed", "[manifold]") {
    PolygonMesh at_corner = boundary_of_cells({{0, 0, 0}, {1, 1, 1}});
    CHECK(make_manifold(at_corner).split_vertices == 1);
    CHECK(manifold_fault(at_corner) == "");
    CHECK(boundary_edges(at_corner) == 0);
    CHECK(volume_of(at_corner) == Approx(2));

    PolygonMesh at_edge = boundary_of_cells({{0, 0, 0}, {1, 1, 0}});
    const ManifoldCounts counts = make_manifold(at_edge);
    CHECK(counts.complex_edges == 1);
    CHECK(counts.opened_edges == 0);
    CHECK(counts.split_vertices == 2);
    CHECK(manifold_fault(at_edge) == "");
    CHECK(boundary_edges(at_edge) == 0);
}

TEST_CASE("an edge of a surface that touches itself between manifold ends is parted too", "[manifold]") {
    // A ring of cells whose ends touch along one edge, and a tunnel pinched along one edge.
    for (const std::set<std::array<int, 3>>& cells :
         {std::set<std::array<int, 3>>{
              {0, 0, 0},
              {0, 1, 0},
              {0, 1, 1},
              {1, 1, 1},
              {1, 1, 0},
              {2, 1, 0},
              {2, 0, 0},
              {1, 0, -1},
              {2, 0, -1},
              {0, 0, -1}},
          std::set<std::array<int, 3>>{
              {0, 0, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 0, -1}, {0, 1, -1}, {1, 1, -1}}}) {
        PolygonMesh mesh = boundary_of_cells(cells);
        make_manifold(mesh);
        CHECK(manifold_fault(mesh) == "");
        CHECK(boundary_edges(mesh) == 0);
        CHECK(volume_of(mesh) == Approx(static_cast<double>(cells.size())));
    }
}

TEST_CASE("random unions of cells become closed manifolds of the same volume", "[manifold]") {
    std::mt19937 random(7);
    for (int round = 0; round < 200; ++round) {
        std::set<std::array<int, 3>> cells;
        for (unsigned i = 0; i < 4 + random() % 60; ++i)
            cells.insert({static_cast<int>(random() % 5), static_cast<int>(random() % 5),
                          static_cast<int>(random() % 5)});
        PolygonMesh mesh = boundary_of_cells(cells);
        make_manifold(mesh);
        CHECK(manifold_fault(mesh) == "");
        CHECK(boundary_edges(mesh) == 0);
        CHECK(volume_of(mesh) == Approx(static_cast<double>(cells.size())));
    }
}

TEST_CASE("three sheets on one edge become a surface and a sheet of its own", "[manifold]") {
    const std::vector<Vec3> corners{{0, 0, 0},  {0, 0, 1},  {1, 0, 0}, {1, 0, 1},
                                    {-1, 0, 0}, {-1, 0, 1}, {0, 1, 0}, {0, 1, 1}};
    PolygonMesh fin = mesh_of(corners, {{0, 1, 3, 2}, {1, 0, 4, 5}, {0, 1, 7, 6}});
    const ManifoldCounts counts = make_manifold(fin);
    CHECK(counts.complex_edges == 1);
    CHECK(counts.opened_edges == 1);
    CHECK(manifold_fault(fin) == "");
    CHECK(fin.facet_count() == 3);
}

TEST_CASE("facets that run along an edge the same way are left open", "[manifold]") {
    PolygonMesh clash = mesh_of({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}}, {{0, 1, 2}, {0, 1, 3}});
    const ManifoldCounts counts = make_manifold(clash);
    CHECK(counts.opened_edges == 2);
    CHECK(manifold_fault(clash) == "");
    CHECK(clash.facet_count() == 2);
}

TEST_CASE("random soups become manifolds, however wild", "[manifold]") {
    std::mt19937 random(11);
    for (int round = 0; round < 400; ++round) {
        const auto vertices = static_cast<Index>(3 + random() % 10),
                   facets = static_cast<Index>(random() % 60);
        PolygonMesh soup;
        for (unsigned i = 0; i < vertices; ++i)
            soup.positions.emplace_back(random() % 4, random() % 4, random() % 4); // coincident ones too
        soup.normals.assign(vertices, Vec3(0, 0, 1));
        soup.properties.push_back(
            {"hsdm_level", VertexProperty::Type::int32, std::vector<double>(vertices, 3)});
        for (unsigned f = 0; f < facets; ++f) {
            std::vector<Index> facet(random() % 7);
            for (Index& v : facet) v = static_cast<Index>(random() % vertices);
            soup.add_facet(facet);
        }
        const bool sound = is_manifold(soup, link_facets(soup));
        CHECK(make_manifold(soup).changed() == !sound);
        CHECK(is_manifold(soup, link_facets(soup)));
        CHECK(manifold_fault(soup) == "");
        CHECK(soup.normals.size() == soup.vertex_count());
        CHECK(soup.properties[0].values.size() == soup.vertex_count());
    }
}

TEST_CASE("closed random soups stay closed", "[manifold]") {
    // Tetrahedra over few vertices, random orientation: as many facets one way as the other along every edge.
    std::mt19937 random(13);
    for (int round = 0; round < 300; ++round) {
        const auto vertices = static_cast<Index>(5 + random() % 6);
        PolygonMesh soup;
        for (unsigned i = 0; i < vertices; ++i)
            soup.positions.emplace_back(random() % 100, random() % 100, random() % 100);
        std::vector<Index> order(vertices);
        for (unsigned i = 0; i < vertices; ++i) order[i] = i;
        std::set<std::vector<Index>> used; // no facet twice: what is removed as a duplicate may leave a hole
        for (unsigned t = 0; t < 1 + random() % 12; ++t) {
            std::shuffle(order.begin(), order.end(), random);
            const Facets facets{{order[0], order[1], order[2]},
                                {order[0], order[3], order[1]},
                                {order[1], order[3], order[2]},
                                {order[2], order[3], order[0]}};
            bool fresh = true;
            for (auto facet : facets) {
                std::sort(facet.begin(), facet.end());
                fresh &= !used.count(facet);
            }
            if (!fresh) continue;
            for (auto facet : facets) {
                soup.add_facet(facet);
                std::sort(facet.begin(), facet.end());
                used.insert(facet);
            }
        }
        make_manifold(soup);
        CHECK(manifold_fault(soup) == "");
        CHECK(boundary_edges(soup) == 0);
    }
}

TEST_CASE("new vertices take over normal and properties", "[manifold]") {
    PolygonMesh mesh = boundary_of_cells({{0, 0, 0}, {1, 1, 1}});
    VertexProperty number{"hsdm_number", VertexProperty::Type::float64, {}};
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
        number.values.push_back(mesh.positions[v][0] + 10 * mesh.positions[v][1]
                                + 100 * mesh.positions[v][2]);
        mesh.normals.push_back(mesh.positions[v]);
    }
    mesh.properties.push_back(number);
    make_manifold(mesh);
    REQUIRE(mesh.vertex_count() == 16);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
        const Vec3& p = mesh.positions[v];
        CHECK(mesh.normals[v] == p);
        CHECK(mesh.properties[0].values[v] == p[0] + 10 * p[1] + 100 * p[2]);
    }
}
