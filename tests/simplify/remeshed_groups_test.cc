#include "hsdm/quality/topology.hh"
#include "hsdm/simplify/nonmanifold_vertices.hh"
#include "hsdm/simplify/remesh_by_flips.hh"
#include "support/meshes.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

using namespace hsdm;

namespace {

constexpr Index block_side = 20; // vertices

/// A bent sheet of triangles over a square.
PolygonMesh sheet() {
    return support::cut_in_two(support::quad_sheet(block_side - 1, block_side - 1, [](Index x, Index y) {
        return Vec3(x, y, 0.06 * std::sin(2.0 * x) * std::cos(3.0 * y));
    }));
}

using Rings = std::multiset<std::vector<Index>>;

/// Each from its least vertex on.
Rings rings(const PolygonMesh& mesh) {
    Rings result;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        std::vector<Index> ring(mesh.facet(f).begin(), mesh.facet(f).end());
        std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
        result.insert(ring);
    }
    return result;
}

void tidy(PolygonMesh& mesh, RemeshedGroups& groups) {
    const PolygonMesh fine = sheet();
    const SurfaceWalk surface(fine);
    const ToleranceEnvelope envelope{surface, 0.02};
    remesh_by_flips(mesh, envelope, std::vector<std::uint8_t>(mesh.vertex_count(), 0), Diagonals::may_flip,
                    groups);
}

} // namespace

TEST_CASE("the same mesh becomes the same again", "[simplify]") {
    RemeshedGroups groups;
    PolygonMesh first = sheet(), second = sheet();
    tidy(first, groups);
    CHECK(groups.size() > 100);
    const std::size_t size = groups.size();
    tidy(second, groups);
    CHECK(rings(second) == rings(first));
    CHECK(rings(first) != rings(sheet()));
    CHECK(groups.size() == size);
}

TEST_CASE("only what changed, and what is beside it, becomes something else", "[simplify]") {
    RemeshedGroups groups;
    PolygonMesh first = sheet(), second = sheet();
    tidy(first, groups);
    const Index moved = 5 * block_side + 6;
    second.positions[moved] += Vec3(0.3, -0.2, 0.1);
    tidy(second, groups);
    const Rings before = rings(first), after = rings(second);
    const auto is_far = [&](const std::vector<Index>& ring) {
        return std::ranges::all_of(ring, [&](Index v) {
            const auto apart = [](Index a, Index b) { return a > b ? a - b : b - a; };
            return std::max(apart(v % block_side, moved % block_side),
                            apart(v / block_side, moved / block_side))
                   > 4;
        });
    };
    Rings far_before, far_after;
    std::ranges::copy_if(before, std::inserter(far_before, far_before.end()), is_far);
    std::ranges::copy_if(after, std::inserter(far_after, far_after.end()), is_far);
    CHECK(far_before.size() > 100);
    CHECK(far_before == far_after);
    CHECK(after != before);
    CHECK(nonmanifold_vertices(second).empty());
    CHECK(measure_topology(second).euler == 1);
    CHECK(measure_topology(second).boundary_edges == measure_topology(sheet()).boundary_edges);
}

TEST_CASE("vertices are known by their origins, whatever their numbers", "[simplify]") {
    RemeshedGroups groups;
    PolygonMesh first = sheet(), turned;
    const PolygonMesh start = sheet();
    const auto count = static_cast<Index>(start.vertex_count());
    for (Index v = count; v-- > 0;) {
        turned.positions.push_back(start.positions[v]);
        turned.origin.push_back(v);
    }
    for (std::size_t f = start.facet_count(); f-- > 0;) {
        std::vector<Index> ring;
        for (Index v : start.facet(f)) ring.push_back(count - 1 - v);
        turned.add_facet(ring);
    }
    tidy(first, groups);
    tidy(turned, groups);
    for (Index& v : turned.corners) v = count - 1 - v;
    CHECK(rings(turned) == rings(first));
}

TEST_CASE("vertices in the same place are not taken for each other", "[simplify]") {
    const auto two_sheets = [] { // with a point in common that is a vertex of either
        PolygonMesh mesh = sheet();
        const PolygonMesh other = sheet();
        const auto count = static_cast<Index>(mesh.vertex_count());
        const Index common = 10 * block_side + 10;
        for (const Vec3& p : other.positions) {
            const Vec3 way = p - other.positions[common];
            mesh.positions.push_back(other.positions[common] + Vec3(way[0], -way[2], way[1]));
        }
        for (std::size_t f = 0; f < other.facet_count(); ++f) {
            std::vector<Index> ring;
            for (Index v : other.facet(f)) ring.push_back(count + v);
            mesh.add_facet(ring);
        }
        return mesh;
    };
    RemeshedGroups groups;
    PolygonMesh first = two_sheets(), second = two_sheets();
    tidy(first, groups);
    tidy(second, groups);
    CHECK(nonmanifold_vertices(second).empty());
    CHECK(measure_topology(second).components == 2);
}

TEST_CASE("a group of hundreds of facets comes once", "[simplify]") {
    constexpr Index across = 600, rows = 6;
    const PolygonMesh mesh =
        support::quad_sheet(across - 1, rows - 1, [](Index x, Index y) { return Vec3(x + 2.0 * y, y, 0); });
    RemeshedGroups groups;
    PolygonMesh first = mesh, second = mesh;
    tidy(first, groups);
    REQUIRE(groups.size() < 256); // of 2,995 facets
    tidy(second, groups);
    CHECK(rings(second) == rings(first));
    CHECK(nonmanifold_vertices(second).empty());
}

TEST_CASE("changes here and there leave no vertex in trouble", "[simplify]") {
    support::Random random(11);
    RemeshedGroups groups;
    PolygonMesh mesh = sheet();
    for (int round = 0; round < 200; ++round) {
        PolygonMesh now = mesh;
        tidy(now, groups);
        CHECK(nonmanifold_vertices(now).empty());
        CHECK(measure_topology(now).euler == 1);
        for (int k = 0; k < 5; ++k) {
            const auto v = static_cast<std::size_t>(random.uniform() * block_side * block_side);
            mesh.positions[v] =
                sheet().positions[v]
                + 0.9 * Vec3(random.uniform() - 0.5, random.uniform() - 0.5, 0.2 * random.uniform());
        }
    }
}

TEST_CASE("groups that do not go together are not taken", "[simplify]") {
    enum : Index { a, b, c, d, e, f, g };
    PolygonMesh mesh;
    mesh.positions = {{0, 0, 0.1}, {-1, 0, 0}, {1, -1, 0}, {1, 1, 0}, {3, 0, 0}, {3, 2, 0}, {5, 1, 0}};
    for (const Triangle& t : {Triangle{a, b, c}, {a, c, d}, {a, d, b}, {d, c, e}, {d, e, f}, {f, e, g}})
        mesh.add_facet(t);
    RemeshedGroups groups;
    groups.mesh = mesh;
    // The edge ab became cd where cd had become ae, which it does not while feg is another facet.
    groups.begin(std::array<Index, 2>{0, 2});
    groups.add_ring(std::array<Index, 3>{d, c, a});
    groups.add_ring(std::array<Index, 3>{c, d, b});
    groups.begin(std::array<Index, 2>{1, 3});
    groups.add_ring(std::array<Index, 3>{a, c, e});
    groups.add_ring(std::array<Index, 3>{a, e, d});
    const std::vector<std::uint8_t> fixed{0, 0, 0, 1, 1, 1, 0};
    const std::vector<Index> found = groups.find(mesh, find_unchanged(mesh, mesh), {0, 0, 0, 0, 1, 0});
    REQUIRE(found == std::vector<Index>{0, no_index, 0, no_index, no_index, no_index});
    const PolygonMesh fine = mesh;
    const SurfaceWalk surface(fine);
    const ToleranceEnvelope envelope{surface, 0.01};
    remesh_by_flips(mesh, envelope, fixed, Diagonals::may_flip, groups);
    CHECK(nonmanifold_vertices(mesh).empty());
    CHECK(measure_topology(mesh).euler == 1);
}
