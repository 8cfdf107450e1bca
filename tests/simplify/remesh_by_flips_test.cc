#include "hsdm/mesh/area_vector.hh"
#include "hsdm/quality/distance_to_surface.hh"
#include "hsdm/quality/topology.hh"
#include "hsdm/simplify/nonmanifold_vertices.hh"
#include "hsdm/simplify/remesh_by_flips.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>

using namespace hsdm;
using support::cut_in_two;

namespace {

constexpr Index sheet_side = 7; // vertices

/// A sheet of quads over a square, `height` at (x, y) up; the vertices by rows.
template <class Height>
PolygonMesh sheet(const Height& height) {
    return support::quad_sheet(sheet_side - 1, sheet_side - 1,
                               [&](Index x, Index y) { return Vec3(x, y, height(double(x), double(y))); });
}

RemeshCounts remeshed(PolygonMesh& mesh, const PolygonMesh& fine, bool fixed = false) {
    constexpr double tolerance = 0.05;
    const SurfaceWalk surface(fine);
    const ToleranceEnvelope envelope{surface, tolerance};
    return remesh_by_flips(mesh, envelope, std::vector<std::uint8_t>(mesh.vertex_count(), fixed));
}

bool has_edge(const PolygonMesh& mesh, Index a, Index b) {
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto ring = mesh.facet(f);
        for (std::size_t i = 0; i < ring.size(); ++i)
            if (ring[i] == a && ring[(i + 1) % ring.size()] == b) return true;
    }
    return false;
}

} // namespace

TEST_CASE("triangles of a flat sheet become quads again", "[simplify]") {
    const PolygonMesh flat = sheet([](double, double) { return 0.0; });
    PolygonMesh mesh = cut_in_two(flat);
    const RemeshCounts counts = remeshed(mesh, flat);
    CHECK(counts.joined >= 30); // of 36
    CHECK(nonmanifold_vertices(mesh).empty());
    CHECK(measure_topology(mesh).euler == 1);
}

TEST_CASE("quads across a crease are cut along it", "[simplify]") {
    // A roof whose ridge runs along the diagonals from (x, x) to (x + 1, x + 1).
    PolygonMesh mesh = sheet([](double x, double y) { return -std::abs(x - y); });
    const PolygonMesh fine = cut_in_two(mesh);
    remeshed(mesh, fine);
    for (Index i = 0; i + 1 < sheet_side; ++i) {
        INFO("ridge from " << i);
        const Index v = i * sheet_side + i;
        CHECK((has_edge(mesh, v, v + sheet_side + 1) || has_edge(mesh, v + sheet_side + 1, v)));
    }
    CHECK(points_to_mesh(fine.positions, mesh).max < 1e-12);
    CHECK(nonmanifold_vertices(mesh).empty());
    CHECK(measure_topology(mesh).euler == 1);
}

TEST_CASE("a triangle without area is no half of a quad", "[simplify]") {
    PolygonMesh mesh;
    mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 1, 0), Vec3(1, 0, 0)};
    mesh.add_facet(std::array<Index, 3>{0, 1, 2});
    mesh.add_facet(std::array<Index, 3>{1, 0, 3}); // its third corner lies on its first
    const PolygonMesh before = mesh;
    CHECK(remeshed(mesh, before).joined == 0);
    CHECK(mesh.facet_count() == 2);
}

TEST_CASE("settled facets stay as they are", "[simplify]") {
    PolygonMesh mesh = sheet([](double x, double y) { return -std::abs(x - y); });
    const PolygonMesh before = mesh;
    const RemeshCounts counts = remeshed(mesh, before, true);
    CHECK(counts.flipped == 0);
    CHECK(counts.joined == 0);
    CHECK(mesh.corners == before.corners);
}
