#include "hsdm/quality/distance_to_surface.hh"
#include "hsdm/quality/topology.hh"
#include "hsdm/simplify/decimate.hh"
#include "hsdm/simplify/planar_patches.hh"
#include "support/check.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <numeric>

using namespace hsdm;

namespace {

constexpr double cell_bound = 0.05;

/// A mesh that is its own leaves, decimated.
struct Decimated {
    PolygonMesh fine;
    DecimatedMesh result;

    Decimated(PolygonMesh mesh, std::vector<Quadric> planes, const DecimateOptions& options = {},
              double band = 0.35)
        : fine(std::move(mesh)) {
        ClusteredMesh leaves{fine, std::vector<Index>(fine.vertex_count())};
        std::iota(leaves.vertex.begin(), leaves.vertex.end(), Index{0});
        leaves.mesh.origin = leaves.vertex;
        MeshChecks checks(fine, nullptr, fine.positions, cell_bound, 0.05, band * cell_bound);
        result = decimate(leaves, std::move(planes), checks, options);
    }
    explicit Decimated(const PolygonMesh& mesh) : Decimated(mesh, vertex_planes(mesh)) {}
};

void check_kept(const Decimated& d) {
    const PolygonMesh& mesh = d.result.mesh;
    CHECK(support::faults(mesh) == "");
    CHECK(measure_topology(mesh).euler == 2);
    CHECK(points_to_mesh(d.fine.positions, mesh).max <= cell_bound);
    CHECK(points_to_mesh(sample_surface(mesh, 2000), d.fine).max <= 1.2 * cell_bound);
    CHECK(d.result.faults.intersecting + d.result.faults.distant + d.result.faults.points == 0);
    CHECK(d.result.far_points.points.empty());
    REQUIRE(d.result.vertex.size() == d.fine.vertex_count());
    std::vector<std::uint8_t> used(mesh.vertex_count(), 0);
    for (Index v : d.result.vertex) {
        REQUIRE(v < mesh.vertex_count());
        used[v] = 1;
    }
    CHECK(std::count(used.begin(), used.end(), 1) == std::ssize(used));
}

} // namespace

TEST_CASE("of a cube its six faces are left, each vertex in one of the corners", "[simplify]") {
    const Decimated d(support::divided_cube(8));
    check_kept(d);
    CHECK(d.result.mesh.vertex_count() == 8);
    CHECK(d.result.mesh.facet_count() == 6);
    for (Index v = 0; v < d.fine.vertex_count(); ++v)
        if (d.fine.positions[v].norm() > 1.7) // a corner stands for itself
            CHECK((d.result.mesh.positions[d.result.vertex[v]] - d.fine.positions[v]).norm() < 1e-9);
}

TEST_CASE("a ball keeps the cell_bound with fewer facets", "[simplify]") {
    const Decimated d(support::divided_sphere(12));
    check_kept(d);
    CHECK(d.result.mesh.facet_count() < d.fine.facet_count() / 3);
    CHECK(d.result.mesh.facet_count() > 30);
}

TEST_CASE("where planes allow anything the cell_bound is kept all the same", "[simplify]") {
    const PolygonMesh fine = support::divided_sphere(8);
    std::vector<Quadric> none(fine.vertex_count());
    for (std::size_t v = 0; v < none.size(); ++v) none[v].add_point(fine.positions[v]);
    const Decimated d(fine, none);
    check_kept(d);
    CHECK(d.result.mesh.vertex_count() < fine.vertex_count());
}

TEST_CASE("if rounds do not suffice the mesh stays as it was", "[simplify]") {
    const PolygonMesh fine = support::divided_sphere(8);
    std::vector<Quadric> none(fine.vertex_count());
    for (std::size_t v = 0; v < none.size(); ++v) none[v].add_point(fine.positions[v]);
    const Decimated d(fine, none, {.faults = {}, .rounds = 1});
    check_kept(d);
    const Decimated enough(support::divided_cube(6), vertex_planes(support::divided_cube(6)),
                           {.faults = {}, .rounds = 1});
    CHECK(enough.result.mesh.facet_count() == 6);
}

TEST_CASE("what goes too far is undone where it does, and all else stays merged", "[simplify]") {
    const PolygonMesh fine = support::divided_sphere(12);
    constexpr double band = 0.7; // by planes more goes than the cell_bound bears
    const Decimated once(fine, vertex_planes(fine), {.faults = {}, .rounds = 1}, band);
    CHECK(once.result.mesh.vertex_count() == fine.vertex_count());
    const Decimated d(fine, vertex_planes(fine), {}, band);
    check_kept(d);
    CHECK(d.result.mesh.vertex_count() < fine.vertex_count() / 5);
}

TEST_CASE("decimation does not depend on the number of threads", "[simplify]") {
    const Decimated many(support::divided_sphere(10));
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const Decimated single(support::divided_sphere(10));
    CHECK(single.result.mesh.corners == many.result.mesh.corners);
    CHECK(single.result.mesh.positions == many.result.mesh.positions);
    CHECK(single.result.vertex == many.result.vertex);
}
