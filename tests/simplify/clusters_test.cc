#include "hsdm/simplify/clusters.hh"
#include "hsdm/simplify/planar_patches.hh"
#include "simplify/grids.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <numbers>
#include <set>

using namespace hsdm;
using support::grid;

namespace {

constexpr int tree_depth = 4;

/// A mesh in the unit cube and its clusters.
struct Gathered {
    PolygonMesh mesh;
    std::vector<Quadric> planes;
    CellTree tree;
    std::vector<ClusterLevel> levels;

    Gathered(PolygonMesh in, double tolerance)
        : mesh(std::move(in)),
          planes(vertex_planes(mesh)),
          tree(build_cell_tree(mesh.positions, 1, tree_depth)),
          levels(build_clusters(mesh, tree, planes, tolerance)) {}

    /// Per vertex, its cluster of a level, or no_index where cells cannot be whole.
    std::vector<Index> of_vertex(std::size_t level) const {
        std::vector<Index> cluster(mesh.vertex_count());
        for (Index v = 0; v < cluster.size(); ++v) {
            cluster[v] = v;
            for (std::size_t l = levels.size() - 1; l > level && cluster[v] != no_index; --l)
                cluster[v] = levels[l].parent[cluster[v]];
        }
        return cluster;
    }
    std::size_t whole(std::size_t level) const {
        const auto& cells = tree.levels[level].whole;
        return static_cast<std::size_t>(std::count(cells.begin(), cells.end(), 1));
    }
};

/// A level sheet of quads, as many along x as along y.
PolygonMesh sheet(Index side, double z) {
    return grid(side, side, [z](double u, double v) { return Vec3(0.02 + 0.96 * u, 0.02 + 0.96 * v, z); });
}

PolygonMesh both(PolygonMesh a, const PolygonMesh& b) {
    const auto base = static_cast<Index>(a.vertex_count());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    for (std::size_t f = 0; f < b.facet_count(); ++f) {
        std::vector<Index> ring(b.facet(f).begin(), b.facet(f).end());
        for (Index& v : ring) v += base;
        a.add_facet(ring);
    }
    return a;
}

/// A part of a paraboloid, whose planes no vertex meets.
PolygonMesh dome(Index side) {
    return grid(side, side, [](double u, double v) {
        const double x = u - 0.5, y = v - 0.5;
        return Vec3(0.02 + 0.96 * u, 0.02 + 0.96 * v, 0.9 - 1.5 * (x * x + y * y));
    });
}

/// Clusters are those of the level below in the cell above, all of them where it can be whole.
void check_levels(const Gathered& found) {
    std::size_t wrong = 0;
    for (std::size_t level = 0; level + 1 < found.levels.size(); ++level) {
        const ClusterLevel &here = found.levels[level], &below = found.levels[level + 1];
        const CellLevel &cells = found.tree.levels[level], &cells_below = found.tree.levels[level + 1];
        std::vector<std::uint8_t> can_be(cells.codes.size(), 1), used(here.size(), 0);
        for (std::size_t c = 0; c < cells_below.codes.size(); ++c)
            if (!cells_below.whole[c]) can_be[cells_below.parent[c]] = 0;
        for (std::size_t c = 0; c < cells.codes.size(); ++c) wrong += cells.whole[c] && !can_be[c];
        REQUIRE(below.parent.size() == below.size());
        REQUIRE(here.cell.size() == here.size());
        for (Index i = 0; i < below.size(); ++i) {
            const Index cell = cells_below.parent[below.cell[i]];
            wrong += (below.parent[i] == no_index) == (can_be[cell] != 0);
            if (below.parent[i] == no_index) continue;
            wrong += here.cell[below.parent[i]] != cell;
            used[below.parent[i]] = 1;
        }
        wrong += std::find(used.begin(), used.end(), 0) != used.end();
    }
    CHECK(wrong == 0);
}

/// Where cells are whole the planes of a cluster's vertices are met by its place, which is in its cell.
void check_places(const Gathered& found, double tolerance) {
    double most = 0;
    for (std::size_t level = 0; level + 1 < found.levels.size(); ++level) {
        const std::vector<Index> cluster = found.of_vertex(level);
        std::vector<Quadric> sums(found.levels[level].size());
        for (Index v = 0; v < cluster.size(); ++v)
            if (cluster[v] != no_index) sums[cluster[v]] += found.planes[v];
        for (Index c = 0; c < sums.size(); ++c)
            if (found.tree.levels[level].whole[found.levels[level].cell[c]])
                most = std::max(most, sums[c].rms(found.levels[level].positions[c]));
    }
    CHECK(most <= tolerance * (1 + 1e-9));
}

} // namespace

TEST_CASE("on the deepest level every vertex is a cluster of its own", "[simplify]") {
    const Gathered found(sheet(40, 0.4), 0.01);
    CHECK(found.levels.size() == tree_depth + 1);
    CHECK(found.levels[tree_depth].positions == found.mesh.positions);
    CHECK(found.levels[tree_depth].cell == found.tree.of_vertex);
    check_levels(found);
}

TEST_CASE("a flat sheet has one cluster in each cell, all the way up", "[simplify]") {
    const Gathered found(sheet(40, 0.4), 1e-6);
    for (std::size_t level = 0; level < tree_depth; ++level) {
        CHECK(found.whole(level) == found.tree.levels[level].codes.size());
        CHECK(found.levels[level].size() == found.tree.levels[level].codes.size());
        for (const Vec3& place : found.levels[level].positions) CHECK(place[2] == Approx(0.4));
    }
    CHECK(found.levels[0].size() == 1);
    check_levels(found);
}

TEST_CASE("sheets that no edge joins stay apart in one cell", "[simplify]") {
    const Gathered found(both(sheet(40, 0.41), sheet(40, 0.43)), 1e-6);
    check_levels(found);
    for (std::size_t level = 0; level < tree_depth; ++level) {
        CHECK(found.levels[level].size() == 2 * found.tree.levels[level].codes.size());
        const std::vector<Index> cluster = found.of_vertex(level);
        const std::size_t half = cluster.size() / 2;
        const std::set<Index> lower(cluster.begin(), cluster.begin() + static_cast<std::ptrdiff_t>(half));
        for (std::size_t v = half; v < cluster.size(); ++v) CHECK(!lower.contains(cluster[v]));
    }
}

TEST_CASE("what bends stays whole only where its planes are met", "[simplify]") {
    std::size_t before = 0;
    for (const double tolerance : {1e-5, 0.003, 0.01, 0.03}) {
        INFO("tolerance " << tolerance);
        const Gathered found(dome(48), tolerance);
        check_levels(found);
        check_places(found, tolerance);
        std::size_t whole = 0;
        for (std::size_t level = 0; level < tree_depth; ++level) whole += found.whole(level);
        CHECK((whole > before || tolerance < 1e-4));
        CHECK((whole > 0 || tolerance < 1e-4));
        CHECK((whole == 0 || tolerance > 1e-4));
        before = whole;
    }
}

TEST_CASE("a cell with a hole of the surface in it is not whole, nor one with a closed surface",
          "[simplify]") {
    PolygonMesh pierced = sheet(40, 0.4);
    PolygonMesh ring;
    ring.positions = pierced.positions;
    for (std::size_t f = 0; f < pierced.facet_count(); ++f) // without facets amid the cell at 0.5 to 0.75
        if (f / 40 < 25 || f / 40 > 26 || f % 40 < 25 || f % 40 > 26) ring.add_facet(pierced.facet(f));
    const Gathered found(ring, 1e-6);
    check_levels(found);
    CHECK(found.whole(3) == found.tree.levels[3].codes.size());
    CHECK(found.whole(2) == found.tree.levels[2].codes.size() - 1);
    CHECK(found.whole(1) == found.tree.levels[1].codes.size() - 1);
    CHECK(found.whole(0) == 0);

    PolygonMesh octahedron; // within a cell of level 2, over several of level 3
    for (unsigned k = 0; k < 6; ++k) {
        Vec3 at(0.625, 0.625, 0.625);
        at[k / 2] += k % 2 == 0 ? 0.04 : -0.04;
        octahedron.positions.push_back(at);
    }
    for (const std::array<Index, 3>& facet : {std::array<Index, 3>{0, 2, 4},
                                              {2, 1, 4},
                                              {1, 3, 4},
                                              {3, 0, 4},
                                              {2, 0, 5},
                                              {1, 2, 5},
                                              {3, 1, 5},
                                              {0, 3, 5}})
        octahedron.add_facet(facet);
    const Gathered closed(octahedron, 1);
    CHECK(closed.whole(3) == closed.tree.levels[3].codes.size());
    CHECK(closed.whole(2) == 0);
}

TEST_CASE("clusters do not depend on the number of threads", "[simplify]") {
    const Gathered many(dome(60), 0.005);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const Gathered single(dome(60), 0.005);
    for (std::size_t level = 0; level <= tree_depth; ++level) {
        CHECK(many.levels[level].cell == single.levels[level].cell);
        CHECK(many.levels[level].parent == single.levels[level].parent);
        CHECK(many.levels[level].positions == single.levels[level].positions);
        CHECK(many.tree.levels[level].whole == single.tree.levels[level].whole);
    }
}
