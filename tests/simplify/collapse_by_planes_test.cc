#include "hsdm/quality/distance.hh"
#include "hsdm/quality/topology.hh"
#include "hsdm/simplify/collapse_by_planes.hh"
#include "hsdm/simplify/nonmanifold_vertices.hh"
#include "hsdm/simplify/planar_patches.hh"
#include "support/check.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <map>

using namespace hsdm;

namespace {

/// The outer facets of cubes in a lattice of n * n * n, of those in `solid`.
template <class Solid>
PolygonMesh surface_of_cubes(int n, const Solid& solid) {
    PolygonMesh mesh;
    std::map<std::array<int, 3>, Index> number;
    const auto vertex = [&](std::array<int, 3> at) {
        const auto [found, added] = number.emplace(at, static_cast<Index>(mesh.positions.size()));
        if (added) mesh.positions.emplace_back(at[0], at[1], at[2]);
        return found->second;
    };
    const auto inside = [&](int x, int y, int z) {
        return std::min({x, y, z}) >= 0 && std::max({x, y, z}) < n && solid(x, y, z);
    };
    const auto add = [&](std::array<int, 3> at, std::size_t axis, bool upper) {
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        if (upper) ++at[axis];
        std::array<Index, 4> ring{};
        for (std::size_t k = 0; k < 4; ++k) {
            std::array<int, 3> corner = at;
            corner[upper ? u : v] += k == 1 || k == 2;
            corner[upper ? v : u] += k >= 2;
            ring[k] = vertex(corner);
        }
        mesh.add_facet(ring);
    };
    for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y)
            for (int z = 0; z < n; ++z) {
                if (!inside(x, y, z)) continue;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    for (int step : {-1, 1}) {
                        std::array<int, 3> next{x, y, z};
                        next[axis] += step;
                        if (!inside(next[0], next[1], next[2])) add({x, y, z}, axis, step > 0);
                    }
            }
    return mesh;
}

PolygonMesh cube(int n) {
    return surface_of_cubes(n, [](int, int, int) { return true; });
}

/// A square bar bent to a frame.
PolygonMesh frame(int n) {
    return surface_of_cubes(n, [n](int x, int y, int z) {
        return z < 2 && std::min({x, y, n - 1 - x, n - 1 - y}) < 2;
    });
}

std::vector<Index> merged(PolygonMesh& mesh, double tolerance) {
    std::vector<PlaneCollapse> plane_collapses;
    const std::vector<double> tolerances(mesh.vertex_count(), tolerance);
    CollapsedMesh collapsed =
        collapse_by_planes(CollapsingMesh(mesh), vertex_planes(mesh), tolerances, plane_collapses);
    mesh = std::move(collapsed.mesh);
    return std::move(collapsed.stands_for);
}

std::size_t kept(const std::vector<Index>& stands_for) {
    std::size_t count = 0;
    for (Index v = 0; v < stands_for.size(); ++v) count += stands_for[v] == v;
    return count;
}

double volume(const PolygonMesh& mesh) {
    double sum = 0;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto ring = mesh.facet(f);
        for (std::size_t i = 2; i < ring.size(); ++i)
            sum += mesh.positions[ring[0]] | (mesh.positions[ring[i - 1]] % mesh.positions[ring[i]]);
    }
    return sum / 6;
}

} // namespace

TEST_CASE("flat ground and straight creases need no vertices but at corners", "[simplify]") {
    PolygonMesh mesh = cube(8);
    CHECK(kept(merged(mesh, 0.01)) == 8);
    CHECK(mesh.facet_count() == 12);
    CHECK(volume(mesh) == Approx(512));
    PolygonMesh bent = frame(8);
    CHECK(kept(merged(bent, 0.01)) == 16);
    CHECK(measure_topology(bent).euler == 0);
    CHECK(volume(bent) == Approx(2 * (64 - 16)));
}

TEST_CASE("merging keeps the topology, whatever the tolerance", "[simplify]") {
    for (const double tolerance : {0.1, 1.0, 100.0})
        for (const bool bent : {false, true}) {
            PolygonMesh mesh = bent ? frame(10) : cube(6);
            merged(mesh, tolerance);
            INFO("tolerance " << tolerance << ", " << (bent ? "frame" : "cube"));
            CHECK(nonmanifold_vertices(mesh).empty());
            CHECK(measure_topology(mesh).closed());
            CHECK(measure_topology(mesh).euler == (bent ? 0 : 2));
            CHECK(volume(mesh) > 0);
        }
}

TEST_CASE("vertices without tolerance stay, and so do facets with nothing to merge", "[simplify]") {
    PolygonMesh mesh = cube(4);
    const PolygonMesh before = mesh;
    CHECK(kept(merged(mesh, 0)) == before.vertex_count());
    CHECK(mesh.corners == before.corners);
    CHECK(mesh.first == before.first);
    // Half of it: the other half stays quads.
    std::vector<double> tolerance(mesh.vertex_count(), 0);
    for (Index v = 0; v < tolerance.size(); ++v)
        if (mesh.positions[v][2] > 2.5) tolerance[v] = 0.01;
    std::vector<PlaneCollapse> plane_collapses;
    const std::vector<Index> stands_for =
        collapse_by_planes(CollapsingMesh(before), vertex_planes(before), tolerance, plane_collapses)
            .stands_for;
    CHECK(plane_collapses.size() == before.vertex_count() - kept(stands_for));
    CHECK(kept(stands_for) < before.vertex_count());
    for (Index v = 0; v < tolerance.size(); ++v)
        if (tolerance[v] == 0) CHECK(stands_for[v] == v);
    std::size_t quads = 0;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) quads += mesh.facet(f).size() == 4;
    CHECK(quads >= 32);
    CHECK(measure_topology(mesh).euler == 2);
}

TEST_CASE("plane_collapses are repeated as far as tolerances allow", "[simplify]") {
    const PolygonMesh before = frame(10);
    const std::vector<Quadric> planes = vertex_planes(before);
    std::vector<double> tolerance(before.vertex_count(), 1.0);
    std::vector<PlaneCollapse> plane_collapses;
    const CollapsingMesh start(before);
    const CollapsedMesh found = collapse_by_planes(start, planes, tolerance, plane_collapses);
    const CollapsedMesh again = collapse_by_planes(start, planes, tolerance, plane_collapses);
    CHECK(again.mesh.corners == found.mesh.corners);
    CHECK(again.mesh.positions == found.mesh.positions);

    for (Index v = 0; v < tolerance.size(); v += 5) tolerance[v] = 0;
    for (Index v = 1; v < tolerance.size(); v += 5) tolerance[v] = 0.01;
    const auto [fewer, stands_for, flipped] = collapse_by_planes(start, planes, tolerance, plane_collapses);
    CHECK(kept(stands_for) <= before.vertex_count() - plane_collapses.size()); // some are straightened away
    CHECK(kept(stands_for) > kept(found.stands_for));
    CHECK(kept(stands_for) < before.vertex_count() / 2);
    std::vector<Quadric> joint(before.vertex_count());
    for (Index v = 0; v < stands_for.size(); ++v) joint[stands_for[v]] += planes[v];
    for (Index v = 0; v < stands_for.size(); ++v) {
        if (tolerance[v] == 0) CHECK(stands_for[v] == v);
        if (stands_for[v] != v) CHECK(tolerance[stands_for[v]] > 0);
        if (tolerance[v] == 0.01) CHECK(joint[stands_for[v]].rms(fewer.positions[stands_for[v]]) <= 0.011);
    }
    CHECK(nonmanifold_vertices(fewer).empty());
    CHECK(measure_topology(fewer).euler == 0);
}

TEST_CASE("vertices at a border stay", "[simplify]") {
    PolygonMesh mesh;
    for (int y = 0; y <= 6; ++y)
        for (int x = 0; x <= 6; ++x) mesh.positions.emplace_back(x, y, 0);
    for (Index y = 0; y < 6; ++y)
        for (Index x = 0; x < 6; ++x)
            mesh.add_facet(std::array{7 * y + x, 7 * y + x + 1, 7 * y + x + 8, 7 * y + x + 7});
    const std::vector<Index> stands_for = merged(mesh, 0.01);
    for (Index v = 0; v < stands_for.size(); ++v)
        if (v % 7 == 0 || v % 7 == 6 || v < 7 || v >= 42) CHECK(stands_for[v] == v);
    CHECK(kept(stands_for) <= 24 + 4); // of 25 inner ones
    CHECK(measure_topology(mesh).boundary_loops == 1);
}

TEST_CASE("merging does not depend on the number of threads", "[simplify]") {
    PolygonMesh one = frame(12), many = one;
    {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
        merged(one, 0.3);
    }
    merged(many, 0.3);
    CHECK(one.corners == many.corners);
    CHECK(one.positions == many.positions);
}

TEST_CASE("a vertex with two fans stays", "[simplify]") {
    const auto touching = [](int x, int y, int z) {
        return (x < 3 && y < 3 && z < 3) || (x >= 3 && y >= 3 && z >= 3);
    };
    for (const double tolerance : {0.01, 100.0}) {
        PolygonMesh mesh = surface_of_cubes(6, touching);
        const auto pinch = static_cast<Index>(
            std::find(mesh.positions.begin(), mesh.positions.end(), Vec3(3, 3, 3)) - mesh.positions.begin());
        const std::vector<Index> stands_for = merged(mesh, tolerance);
        CHECK(stands_for[pinch] == pinch);
        CHECK(std::count(stands_for.begin(), stands_for.end(), pinch) == 1);
        for (Index v : mesh.corners) CHECK(stands_for[v] == v);
        CHECK(measure_topology(mesh).boundary_edges == 0);
    }
}

TEST_CASE("a vertex moves only as far as its facets allow", "[simplify]") {
    const PolygonMesh mesh = cube(6);
    CollapsingMesh moving(mesh);
    moving.forget_changes();
    Index side = 0; // of a vertex amid a face
    while (moving.at(moving.start(side)) != Vec3(2, 2, 0)) ++side;
    const Index v = moving.start(side);
    CHECK(!moving.move(side, Vec3(3.5, 2, 0)));  // past its neighbour
    CHECK(!moving.move(side, Vec3(2, 2, 0.95))); // facets would turn
    CHECK(moving.at(v) == Vec3(2, 2, 0));
    CHECK(!moving.has_changed(v));
    CHECK(moving.move(side, Vec3(2.2, 2.1, 0)));
    CHECK(moving.at(v) == Vec3(2.2, 2.1, 0));
    CHECK(moving.has_changed(v));
    CHECK(support::faults(moving.write().mesh) == "");
}
