#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/pipeline/measure.hh"
#include "hsdm/pipeline/warnings.hh"
#include "hsdm/simplify/simplify.hh"
#include "hsdm/spatial/self_intersections.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;

namespace {

/// Two sheets of 12 x 12 unit quads that cross where x = 6.3; one of them at the height z = slope (x - 6.3).
PolygonMesh crossing_sheets(double slope) {
    PolygonMesh mesh;
    for (const double tilt : {0.0, slope}) {
        const auto base = static_cast<Index>(mesh.vertex_count());
        const PolygonMesh sheet =
            support::quad_sheet(12, 12, [&](Index c, Index r) { return Vec3(c, r, tilt * (c - 6.3)); });
        mesh.positions.insert(mesh.positions.end(), sheet.positions.begin(), sheet.positions.end());
        for (std::size_t f = 0; f < sheet.facet_count(); ++f) {
            std::vector<Index> ring(sheet.facet(f).begin(), sheet.facet(f).end());
            for (Index& v : ring) v += base;
            mesh.add_facet(ring);
        }
    }
    return mesh;
}

} // namespace

TEST_CASE("a warning has its place in the cloud's coordinates, and none is said twice", "[warnings]") {
    const CloudFrame frame(Box{{0, 0, 0}, {0x1p-40, 0x1p-40, 0x1p-40}});
    REQUIRE(frame.unit() != 1);
    Report report;
    warn(warning_of::sides, {}, frame, report);
    CHECK(report.warnings.empty());
    warn(warning_of::sides, {3, {1, 2, 3}}, frame, report);
    REQUIRE(report.warnings.size() == 1);
    CHECK(report.warnings[0].what == warning_of::sides);
    CHECK(report.warnings[0].how_much == 3);
    CHECK(report.warnings[0].where == Vec3(1, 2, 3) * frame.unit());
    warn(warning_of::intersections, {1, {0, 0, 0}}, frame, report);
    warn_anew(warning_of::sides, {2, {0, 0, 0}}, frame, report);
    REQUIRE(report.warnings.size() == 2);
    CHECK(report.warnings[0].what == warning_of::intersections);
    CHECK(report.warnings[1].how_much == 2);
    warn_anew(warning_of::sides, {}, frame, report);
    CHECK(report.warnings.size() == 1);
}

TEST_CASE("intersections that are counted are warned of with a place where they are", "[warnings]") {
    const PolygonMesh crossing = crossing_sheets(1);
    Report report;
    count_intersections(to_mesh(crossing).mesh, report);
    REQUIRE(report.mesh.intersections == find_self_intersections(crossing).facet_pairs.size());
    REQUIRE(report.warnings.size() == 1);
    CHECK(report.warnings[0].what == warning_of::intersections);
    CHECK(report.warnings[0].how_much == static_cast<double>(*report.mesh.intersections));
    CHECK(std::abs(report.warnings[0].where[0] - 6.3) < 1.5);
    // A mesh that has none takes the warning back.
    count_intersections(to_mesh(support::unit_cube()).mesh, report);
    CHECK(report.mesh.intersections == 0u);
    CHECK(report.warnings.empty());
}

TEST_CASE("a simplified mesh tells the intersections that it has", "[warnings]") {
    for (const double slope : {0.0, 1.0}) {
        PolygonMesh fine = slope > 0 ? crossing_sheets(slope) : support::divided_sphere(12);
        for (Vec3& p : fine.positions) p = p * (slope > 0 ? 1 : 6) + Vec3(8, 8, 8);
        const AdaptiveMesh coarse = simplify(fine, fine.positions, 32, 5, {.max_error = 0.05});
        CHECK(coarse.intersecting == find_self_intersections(coarse.mesh).facet_pairs.size());
        CHECK((coarse.intersecting > 0) == (slope > 0));
    }
}
