#include "hsdm/completion/complete_surface.hh"
#include "hsdm/errors.hh"
#include "hsdm/mesh/remove_facets.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace hsdm;

namespace {

template <class Gone>
PolygonMesh without(PolygonMesh mesh, const Gone& gone) {
    remove_facets(mesh, [&](std::size_t f) {
        return std::ranges::all_of(mesh.facet(f), [&](Index v) { return gone(mesh.positions[v]); });
    });
    return mesh;
}

void turn(PolygonMesh& mesh) {
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        std::reverse(mesh.corners.begin() + mesh.first[f], mesh.corners.begin() + mesh.first[f + 1]);
}

/// A tube of radius 1 with closed ends far off, cut through in the middle.
PolygonMesh cut_tube(double gap) {
    return without(support::round_tube(80, 120, 1, 0.05),
                   [&](const Vec3& p) { return std::abs(p[2] - 3) < 0.5 * gap + 0.05; });
}

/// A ring, four times as high as thick, without the wall of its bore, whose ends are funnels.
PolygonMesh tall_ring() {
    return support::quad_tube(100, 120, [](Index c, Index r) {
        const double turn = 2 * std::numbers::pi * c / 100, up = 1.9 * (r / 60.0 - 1);
        const double radius = 1 + 0.5 * std::cos(up);
        return Vec3(radius * std::cos(turn), radius * std::sin(turn), 2 * std::sin(up));
    });
}

/// Points about the axis of the gap.
std::ptrdiff_t near_axis(const CompletedPoints& points) {
    return std::ranges::count_if(points.positions, [](const Vec3& p) {
        return std::hypot(p[0], p[1]) < 0.2 && std::abs(p[2] - 3) < 2;
    });
}

} // namespace

TEST_CASE("a closed mesh needs no points, a voxel size must be positive", "[completion]") {
    const CompletedPoints none = complete_surface(support::divided_sphere(8), 0.1);
    CHECK(none.positions.empty());
    CHECK(complete_surface(PolygonMesh(), 0.1).positions.empty());
    CHECK_THROWS_AS(complete_surface(support::divided_sphere(8), 0), OptionError);
    CHECK_THROWS_AS(complete_surface(support::divided_sphere(8), std::nan("")), OptionError);
}

TEST_CASE("a hole in a sphere is completed by a cap that continues its slope", "[completion]") {
    // The cap is 0.92 across and 0.11 high; a disc over the border would be that far off in the middle.
    for (const bool inward : {false, true}) {
        PolygonMesh mesh = without(support::divided_sphere(40), [](const Vec3& p) { return p[2] > 0.89; });
        if (inward) turn(mesh);
        const CompletedPoints points = complete_surface(mesh, 0.05);
        CHECK(points.positions.size() > 9 * 200);
        REQUIRE(points.normals.size() == points.positions.size());
        double farthest = 0, least = 1, highest = 0;
        for (std::size_t i = 0; i < points.positions.size(); ++i) {
            const Vec3& p = points.positions[i];
            farthest = std::max(farthest, std::abs(p.norm() - 1));
            highest = std::max(highest, p[2]);
            least = std::min(least, (points.normals[i] | p) * (inward ? -1 : 1) / p.norm());
        }
        CHECK(farthest < 0.012);
        CHECK(highest > 0.985);
        CHECK(least > 0.98);
    }
}

TEST_CASE("a hole that a sphere turns through by 106 degrees is completed by a cap, too", "[completion]") {
    // A disc over the border would be 0.4 off in the middle.
    const PolygonMesh mesh = without(support::divided_sphere(40), [](const Vec3& p) { return p[2] > 0.6; });
    const CompletedPoints points = complete_surface(mesh, 0.05);
    REQUIRE(points.positions.size() > 9 * 700);
    double farthest = 0, mean = 0, highest = 0;
    for (const Vec3& p : points.positions) {
        farthest = std::max(farthest, std::abs(p.norm() - 1));
        mean += std::abs(p.norm() - 1) / static_cast<double>(points.positions.size());
        highest = std::max(highest, p[2]);
    }
    CHECK(farthest < 0.1);
    CHECK(mean < 0.035);
    CHECK(highest > 0.9);
}

TEST_CASE("the missing face of a cube is flat and meets the others in creases", "[completion][accuracy]") {
    const PolygonMesh mesh = without(support::divided_cube(30), [](const Vec3& p) { return p[2] < -0.999; });
    const CompletedPoints points = complete_surface(mesh, 0.07);
    CHECK(points.positions.size() > 9 * 700);
    double mean = 0;
    for (std::size_t i = 0; i < points.positions.size(); ++i) {
        const Vec3& p = points.positions[i];
        mean += std::abs(p[2] + 1) / static_cast<double>(points.positions.size());
        CHECK(std::abs(p[2] + 1) < 0.1);
        if (std::max(std::abs(p[0]), std::abs(p[1])) < 0.8) CHECK(points.normals[i][2] < -0.98);
    }
    CHECK(mean < 0.01);
}

TEST_CASE("two loops that face each other closely are joined, far ones closed each",
          "[completion][accuracy]") {
    const CompletedPoints near = complete_surface(cut_tube(0.3), 0.06),
                          far = complete_surface(cut_tube(2.2), 0.06);
    CHECK(near_axis(near) == 0);
    CHECK(near_axis(far) > 2 * 9 * 10);
    for (const Vec3& p : near.positions)
        if (std::abs(p[2] - 3) < 1) CHECK(std::abs(std::hypot(p[0], p[1]) - 1) < 0.05);
}

TEST_CASE("a completion that is stopped does not pass through the mesh", "[completion]") {
    // Two balls, one in the other, the inner one turned: a shell. Over the outer one's border a smooth cap
    // that ends in a crease is flat, and passes through the inner one.
    PolygonMesh mesh = without(support::divided_sphere(40), [](const Vec3& p) { return p[2] < -0.2; });
    PolygonMesh inner = support::divided_sphere(40);
    turn(inner);
    const auto shift = static_cast<Index>(mesh.vertex_count());
    for (const Vec3& p : inner.positions) mesh.positions.push_back(p * 0.9);
    for (std::size_t f = 0; f < inner.facet_count(); ++f) {
        std::vector<Index> corners;
        for (const Index v : inner.facet(f)) corners.push_back(v + shift);
        mesh.add_facet(corners);
    }
    const auto inside = [&](Passing passing) {
        const CompletedPoints points =
            complete_surface(mesh, boundary_loops(mesh), 0.05, {.passing = passing});
        CHECK(points.positions.size() > 9 * 500);
        return std::ranges::count_if(points.positions, [](const Vec3& p) { return p.norm() < 0.89; });
    };
    CHECK(inside(Passing::ignored) > 1000);
    CHECK(inside(Passing::stopped) == 0);
}

TEST_CASE("a completion that takes more memory than there is says how much", "[completion]") {
    const PolygonMesh mesh = cut_tube(0.5);
    const BoundaryLoops loops = boundary_loops(mesh);
    const CompletedPoints points = complete_surface(mesh, loops, 0.03);
    CHECK(points.positions.size() > 1000);
    CHECK(complete_surface(mesh, loops, 0.03, {.most_bytes = 100000000}).positions == points.positions);
    CHECK_THROWS_WITH(complete_surface(mesh, loops, 0.03, {.most_bytes = 100000}),
                      Catch::Contains("MB beside the mesh, which is held in memory"));
}

TEST_CASE("what was looked through decides whether loops are joined", "[completion]") {
    const auto completed = [](PolygonMesh mesh, const std::function<bool(const Vec3&)>& empty) {
        return complete_surface(mesh, boundary_loops(mesh), 0.06, {.empty = empty});
    };
    // Between the two ends of a gap that would be bridged.
    const CompletedPoints parted =
        completed(cut_tube(0.5), [](const Vec3& p) { return std::abs(p[2] - 3) < 0.07; });
    CHECK(near_axis(parted) > 2 * 9 * 10);
    for (const Vec3& p : parted.positions) CHECK(std::abs(p[2] - 3) > 0.04);
    // Along a bore whose two ends would be closed.
    const auto along_bore = [](const Vec3& p) { return std::hypot(p[0], p[1]) < 0.3; };
    const auto closing_bore = [&](const CompletedPoints& points) {
        CHECK(points.positions.size() > 9 * 200);
        return std::ranges::count_if(points.positions,
                                     [](const Vec3& p) { return std::hypot(p[0], p[1]) < 0.15; });
    };
    CHECK(closing_bore(completed(tall_ring(), {})) > 2 * 9 * 5);
    CHECK(closing_bore(completed(tall_ring(), along_bore)) == 0);
}
