#include "hsdm/spatial/surface_walk.hh"
#include "support/meshes.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>

using namespace hsdm;

namespace {

/// A border, sides that turn, and a far side within reach.
PolygonMesh tube(double radius) {
    return support::round_tube(24, 8, radius, 1);
}

/// Facets that share no vertex, and slivers among them: nothing to walk over.
PolygonMesh loose(std::size_t triangles) {
    support::Random random(3);
    PolygonMesh mesh;
    for (Index t = 0; t < triangles; ++t) {
        const Vec3 at(10 * random.uniform(), 10 * random.uniform(), 10 * random.uniform());
        const double thin = t % 3 == 0 ? 1e-9 : 1;
        mesh.positions.insert(mesh.positions.end(),
                              {at, at + Vec3(1, 0.1, 0), at + Vec3(0.5, 0.05 + thin, 1 - thin)});
        mesh.add_facet(std::array{3 * t, 3 * t + 1, 3 * t + 2});
    }
    return mesh;
}

std::vector<Vec3> places_about(const PolygonMesh& mesh, std::size_t count) {
    Box box;
    for (const Vec3& p : mesh.positions) box.add(p);
    support::Random random(5);
    std::vector<Vec3> places;
    const double margin = 0.2 * box.diagonal();
    Vec3 here = box.lo;
    for (std::size_t i = 0; i < count; ++i) {
        for (unsigned k = 0; k < 3; ++k) {
            const double across = box.hi[k] - box.lo[k] + 2 * margin;
            if (i % 10 == 0)
                here[k] = box.lo[k] - margin + across * random.uniform(); // a jump
            else
                here[k] += 0.5 * (random.uniform() - 0.5);
        }
        places.push_back(here);
    }
    return places;
}

/// Every answer against the tree's, where triangles are looked up in cells and where they are not.
void check_against_tree(const PolygonMesh& mesh, double cell_size) {
    const MeshDistance exact(mesh);
    const FacetCells cells(mesh, cell_size);
    REQUIRE(cells.usable());
    const Triangulation cut = triangulate(mesh);
    const SurfaceWalk by_tree(mesh), by_cells(mesh, cut, cells);
    for (const SurfaceWalk* surface : {&by_tree, &by_cells}) {
        INFO((surface == &by_cells ? "cells" : "tree"));
        Index hint = no_index;
        support::Random random(7);
        for (const Vec3& p : places_about(mesh, 3000)) {
            const double least = exact(p);
            Index from = hint;
            CHECK(surface->distance(p, from) == Approx(least).epsilon(1e-9));
            const Index found = surface->triangle_within(p, 1.00001 * least + 1e-5, hint);
            REQUIRE(found != no_index);
            PolygonMesh alone;
            for (const Index v : cut.triangles[found]) alone.positions.push_back(mesh.positions[v]);
            alone.add_facet(Triangle{0, 1, 2});
            CHECK(MeshDistance(alone)(p) <= 1.00002 * least + 2e-5);
            const double more = least * (0.5 + 2 * random.uniform());
            if (surface->leads_within(p, more, hint)) CHECK(least <= 1.00001 * more + 1e-5);
            if (least > 1e-3) {
                CHECK(surface->is_beyond(p, 0.99 * least, hint));
                CHECK(!surface->leads_within(p, 0.99 * least, hint));
            }
            const double enough = surface->distance(p, hint, 2 * least + 0.01);
            CHECK(enough <= 2 * least + 0.01001);
            CHECK(enough >= 0.99999 * least - 1e-5);
        }
    }
}

} // namespace

TEST_CASE("walks find what the tree finds on a tube", "[distance]") {
    check_against_tree(tube(3), 1);
    check_against_tree(tube(0.3), 0.8); // its other side is in the same cell
}

TEST_CASE("where there is nothing to walk over triangles are found all the same", "[distance]") {
    check_against_tree(loose(40), 2);
}

TEST_CASE("a walk leads along a sheet, not across to another", "[distance]") {
    PolygonMesh mesh;
    for (const double z : {0.0, 0.1})
        mesh.positions.insert(mesh.positions.end(),
                              {Vec3(0, 0, z), Vec3(1, 0, z), Vec3(1, 1, z), Vec3(0, 1, z)});
    mesh.add_facet(std::array<Index, 4>{0, 1, 2, 3});
    mesh.add_facet(std::array<Index, 4>{7, 6, 5, 4});
    const SurfaceWalk surface(mesh);
    Index lower = 0, upper = 2;
    CHECK(surface.leads_within(Vec3(0.8, 0.7, 0.09), 0.02, upper));
    CHECK(!surface.leads_within(Vec3(0.8, 0.7, 0.09), 0.02, lower));
    CHECK(!surface.is_beyond(Vec3(0.8, 0.7, 0.09), 0.02, lower));
}

TEST_CASE("far from the surface a walk with cells falls back on the tree", "[distance]") {
    const PolygonMesh mesh = tube(3);
    const FacetCells cells(mesh, 1);
    const SurfaceWalk surface(mesh, triangulate(mesh), cells);
    const MeshDistance exact(mesh);
    for (const double far : {10.0, 1e3, 1e6}) {
        Index hint = no_index;
        const Vec3 p(far, 2 * far, -far);
        CHECK(surface.distance(p, hint) == Approx(exact(p)));
        CHECK(!surface.is_beyond(p, 1.001 * exact(p), hint));
        CHECK(surface.is_beyond(p, 0.999 * exact(p), hint));
    }
}

TEST_CASE("triangles without area are found in their cells", "[distance]") {
    support::Random random(13);
    for (int trial = 0; trial < 200; ++trial) {
        const Vec3 a(random.uniform(), random.uniform(), random.uniform());
        const Vec3 way(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
        PolygonMesh mesh;
        mesh.positions = {a, a + way, a + random.uniform() * way};
        mesh.add_facet(std::array<Index, 3>{0, 1, 2});
        const FacetCells cells(mesh, 0.5);
        REQUIRE(cells.usable());
        const SurfaceWalk surface(mesh, triangulate(mesh), cells);
        for (int k = 0; k < 10; ++k) {
            const Vec3 p = a + 0.6 * Vec3(random.uniform(), random.uniform(), random.uniform());
            Index hint = no_index;
            CHECK(!surface.is_beyond(p, 1.01 * MeshDistance(mesh)(p), hint));
        }
    }
}
