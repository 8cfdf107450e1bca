#include "hsdm/basic/minimal_loop.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>

using namespace hsdm;

namespace {

/// A graph from undirected edges, without an octree.
ConnectivityGraph make_graph(std::vector<Vec3> positions, const std::vector<std::pair<Index, Index>>& edges) {
    ConnectivityGraph graph;
    graph.positions = std::move(positions);
    std::set<std::pair<Index, Index>> half_edges;
    for (auto [a, b] : edges) {
        half_edges.insert({a, b});
        half_edges.insert({b, a});
    }
    graph.first_edge.assign(graph.vertex_count() + 1, 0);
    for (auto [a, b] : half_edges) {
        ++graph.first_edge[a + 1];
        graph.end.push_back(b);
    }
    for (std::size_t v = 0; v < graph.vertex_count(); ++v) {
        graph.first_edge[v + 1] += graph.first_edge[v];
        graph.voxel.push_back(static_cast<Index>(v));
    }
    for (auto [a, b] : half_edges) graph.twin.push_back(graph.find(b, a));
    return graph;
}

/// width x height vertices in the plane, joined along rows and columns; vertex x + width y at (x, y, 0).
ConnectivityGraph grid(int width, int height) {
    std::vector<Vec3> positions;
    std::vector<std::pair<Index, Index>> edges;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto v = static_cast<Index>(x + width * y);
            positions.emplace_back(x, y, 0);
            if (x > 0) edges.emplace_back(v, v - 1);
            if (y > 0) edges.emplace_back(v, v - static_cast<Index>(width));
        }
    return make_graph(positions, edges);
}

std::vector<Index> vertices(const ConnectivityGraph& graph, std::span<const Index> half_edges) {
    std::vector<Index> v;
    for (Index h : half_edges) v.push_back(graph.start(h));
    return v;
}

bool is_closed_walk(const ConnectivityGraph& graph, std::span<const Index> half_edges) {
    bool closed = !half_edges.empty();
    for (std::size_t i = 0; i < half_edges.size(); ++i) {
        const Index next = half_edges[(i + 1) % half_edges.size()];
        closed &= graph.end[half_edges[i]] == graph.start(next) && next != graph.twin[half_edges[i]];
    }
    return closed;
}

} // namespace

TEST_CASE("the walk closes a quad of a grid in four edges", "[loops]") {
    ConnectivityGraph graph = grid(3, 2);
    graph.positions[4] += Vec3(0, -0.1, 0); // the cell on the left comes nearer to the start
    const Loop loop = walk_minimal_loop(graph, graph.find(0, 1));
    CHECK(vertices(graph, loop.edges()) == std::vector<Index>{0, 1, 4, 3});
    CHECK(is_closed_walk(graph, loop.edges()));
}

TEST_CASE("the walk goes round either side of an edge, as the first edge's direction says", "[loops]") {
    ConnectivityGraph graph = grid(2, 3);
    graph.positions[5] += Vec3(-0.3, 0, 0);
    const Loop loop = walk_minimal_loop(graph, graph.find(2, 3));
    CHECK(vertices(graph, loop.edges()) == std::vector<Index>{2, 3, 5, 4});
    const Loop back = walk_minimal_loop(graph, graph.find(3, 2));
    CHECK(back.size == 4);
    CHECK(is_closed_walk(graph, back.edges()));
}

TEST_CASE("the walk never turns back and gives up at a dead end or beyond its bound", "[loops]") {
    const ConnectivityGraph path = make_graph({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1}, {1, 2}});
    CHECK(walk_minimal_loop(path, path.find(0, 1)).size == 0);
    std::vector<Vec3> ring;
    std::vector<std::pair<Index, Index>> edges;
    for (Index i = 0; i < 7; ++i) {
        ring.emplace_back(std::cos(i), std::sin(i), 0);
        edges.emplace_back(i, (i + 1) % 7);
    }
    const ConnectivityGraph seven = make_graph(ring, edges);
    CHECK(walk_minimal_loop(seven, seven.find(0, 1), 6).size == 0);
    CHECK(walk_minimal_loop(seven, seven.find(0, 1), 7).size == 7);
    CHECK(minimal_loops_through(seven, seven.find(0, 1), 6).empty());
    REQUIRE(minimal_loops_through(seven, seven.find(0, 1), 7).size() == 1);
    CHECK(find_short_loops(seven).size() == 0);
}

TEST_CASE("loops through an edge come shortest first, then nearest first", "[loops]") {
    // Edge 0-1 with a triangle (apex 2), a near quad (3, 4) and a far one (5, 6).
    const ConnectivityGraph graph =
        make_graph({{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {1, -1, 0}, {0, -1, 0}, {1, 0, 2}, {0, 0, 2}},
                   {{0, 1}, {1, 2}, {2, 0}, {1, 3}, {3, 4}, {4, 0}, {1, 5}, {5, 6}, {6, 0}});
    const std::vector<Loop> loops = minimal_loops_through(graph, graph.find(0, 1), 4);
    REQUIRE(loops.size() == 3);
    CHECK(vertices(graph, loops[0].edges()) == std::vector<Index>{0, 1, 2});
    CHECK(vertices(graph, loops[1].edges()) == std::vector<Index>{0, 1, 3, 4});
    CHECK(vertices(graph, loops[2].edges()) == std::vector<Index>{0, 1, 5, 6});
    for (const Loop& loop : loops) CHECK(is_closed_walk(graph, loop.edges()));
    CHECK(minimal_loops_through(graph, graph.find(0, 1), 3).size() == 1);
}

TEST_CASE("a loop with a chord is left to the two loops it consists of", "[loops]") {
    const ConnectivityGraph graph =
        make_graph({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}});
    CHECK(find_short_loops(graph).size() == 2);
    for (const Loop& loop : minimal_loops_through(graph, graph.find(0, 1), 5)) CHECK(loop.size == 3);
}

TEST_CASE("every cell of a grid is listed once as a short loop", "[loops]") {
    const ConnectivityGraph graph = grid(60, 50);
    const LoopList loops = find_short_loops(graph);
    REQUIRE(loops.size() == 59 * 49);
    bool closed = true;
    std::set<std::vector<Index>> cells;
    for (std::size_t i = 0; i < loops.size(); ++i) {
        closed &= is_closed_walk(graph, loops[i]) && loops[i].size() == 4;
        std::vector<Index> v = vertices(graph, loops[i]);
        std::sort(v.begin(), v.end());
        cells.insert(v);
    }
    CHECK(closed);
    CHECK(cells.size() == loops.size());
}
