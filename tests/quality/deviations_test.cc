// Signed deviations: which side of a mesh points lie on, beside its edges and corners too.
#include "hsdm/errors.hh"
#include "hsdm/quality/deviations.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numbers>

using namespace hsdm;

namespace {

/// The cube [-1, 1]^3 of six quads, outward.
PolygonMesh cube() {
    PolygonMesh mesh;
    for (unsigned v = 0; v < 8; ++v)
        mesh.positions.emplace_back(v & 1 ? 1 : -1, v & 2 ? 1 : -1, v & 4 ? 1 : -1);
    for (const std::array<Index, 4>& quad : std::initializer_list<std::array<Index, 4>>{
             {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
        mesh.add_facet(quad);
    return mesh;
}

/// The exact signed distance from that cube.
double from_cube(const Vec3& p) {
    Vec3 out(0, 0, 0);
    double inside = -1;
    for (unsigned k = 0; k < 3; ++k) {
        out[k] = std::max(0.0, std::abs(p[k]) - 1);
        inside = std::max(inside, std::abs(p[k]) - 1);
    }
    return inside > 0 ? out.norm() : inside;
}

/// A lattice through the cube and around it, off its planes of symmetry.
std::vector<Vec3> lattice() {
    std::vector<Vec3> points;
    for (int x = -8; x <= 8; ++x)
        for (int y = -8; y <= 8; ++y)
            for (int z = -8; z <= 8; ++z)
                points.emplace_back(0.21 * x + 0.003, 0.21 * y + 0.005, 0.21 * z + 0.011);
    return points;
}

void turn_over(PolygonMesh& mesh) {
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        std::reverse(mesh.corners.begin() + mesh.first[f], mesh.corners.begin() + mesh.first[f + 1]);
}

} // namespace

TEST_CASE("deviations are positive outside and negative inside, beside edges and corners too", "[distance]") {
    const std::vector<Vec3> points = lattice();
    PolygonMesh mesh = cube();
    const Deviations deviations = measure_deviations(points, mesh);
    turn_over(mesh);
    const Deviations turned = measure_deviations(points, mesh);
    for (std::size_t i = 0; i < points.size(); ++i) {
        INFO(points[i]);
        CHECK(deviations.of_points[i] == Approx(from_cube(points[i])).margin(1e-12));
        CHECK(turned.of_points[i] == Approx(-from_cube(points[i])).margin(1e-12));
    }
}

TEST_CASE("a thin spike's tip is outside for points before it, whichever facet they are nearest to",
          "[distance]") {
    PolygonMesh spike;
    const int sides = 7;
    for (int k = 0; k < sides; ++k) {
        const double a = 2 * std::numbers::pi * k / sides;
        spike.positions.emplace_back(0.02 * std::cos(a), 0.02 * std::sin(a), 0);
    }
    spike.positions.emplace_back(0.015, 0, 3); // slanted
    std::vector<Index> base;
    for (Index k = 0; k < sides; ++k) {
        spike.add_facet(std::array<Index, 3>{k, (k + 1) % sides, sides});
        base.insert(base.begin(), k);
    }
    spike.add_facet(base);
    std::vector<Vec3> before;
    for (int k = 0; k < 50; ++k) before.emplace_back(0.015 + 0.2 * std::cos(k), 0.2 * std::sin(k), 3.2);
    for (const double d : measure_deviations(before, spike).of_points) CHECK(d > 0.2);
}

TEST_CASE("a vertex has the mean deviation of the points nearest to it, and none where there are none",
          "[distance]") {
    PolygonMesh mesh = cube();
    std::vector<Vec3> points;
    for (int x = -9; x <= 9; ++x)
        for (int y = -9; y <= 9; ++y) points.emplace_back(0.1 * x, 0.1 * y, 1 + 0.1);
    const std::vector<double> at = measure_deviations(points, mesh).at_vertices;
    REQUIRE(at.size() == 8);
    for (unsigned v = 0; v < 8; ++v) {
        if (v < 4)
            CHECK(std::isnan(at[v]));
        else
            CHECK(at[v] == Approx(0.1));
    }
}

TEST_CASE("deviations of meshes of any size are right", "[distance]") {
    const std::vector<Vec3> points = lattice();
    for (const int power : {-900, 900}) {
        PolygonMesh mesh = cube();
        std::vector<Vec3> scaled = points;
        for (std::vector<Vec3>* places : {&mesh.positions, &scaled})
            for (Vec3& p : *places)
                for (double& x : p) x = std::ldexp(x, power);
        const Deviations deviations = measure_deviations(scaled, mesh);
        for (std::size_t i = 0; i < points.size(); ++i)
            CHECK(std::ldexp(deviations.of_points[i], -power) == Approx(from_cube(points[i])).margin(1e-12));
    }
}

TEST_CASE("nothing deviates from a mesh without facets", "[distance]") {
    CHECK_THROWS_AS(measure_deviations(std::vector<Vec3>(3), PolygonMesh()), Error);
}

TEST_CASE("points that are not finite deviate by nothing that is known, and from no vertex", "[quality]") {
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();
    std::vector<Vec3> points{{0, 0, 1.5}};
    const Deviations without = measure_deviations(points, cube());
    points.insert(points.begin(), {Vec3(nan, 0, 0), Vec3(0, infinity, 0)});
    const Deviations with = measure_deviations(points, cube());
    CHECK(std::isnan(with.of_points[0]));
    CHECK(std::isnan(with.of_points[1]));
    CHECK(with.of_points[2] == 0.5);
    for (std::size_t v = 0; v < 8; ++v)
        CHECK((with.at_vertices[v] == without.at_vertices[v]
               || (std::isnan(with.at_vertices[v]) && std::isnan(without.at_vertices[v]))));
}
