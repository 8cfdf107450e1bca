#include "hsdm/mesh/triangulate.hh"
#include "hsdm/mesh/weld.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;

namespace {

PolygonMesh polygon(const std::vector<Vec3>& ring) {
    PolygonMesh mesh;
    mesh.positions = ring;
    std::vector<Index> facet(ring.size());
    for (Index v = 0; v < ring.size(); ++v) facet[v] = v;
    mesh.add_facet(facet);
    return mesh;
}

Vec3 area(const PolygonMesh& mesh, const Triangle& t) {
    return (mesh.positions[t[1]] - mesh.positions[t[0]]) % (mesh.positions[t[2]] - mesh.positions[t[0]]) / 2;
}

/// Least and total area of the triangles along z.
std::pair<double, double> areas(const PolygonMesh& mesh) {
    double least = std::numeric_limits<double>::infinity(), total = 0;
    for (const Triangle& t : triangulate(mesh).triangles) {
        least = std::min(least, area(mesh, t)[2]);
        total += area(mesh, t)[2];
    }
    return {least, total};
}

} // namespace

TEST_CASE("a quad is cut along its shorter diagonal", "[triangulate]") {
    const auto cut = triangulate(polygon({{0, 0, 0}, {3, -1, 0}, {4, 0, 0}, {3, 1, 0}}));
    REQUIRE(cut.size() == 2);
    CHECK(cut.triangles[0] == Triangle{0, 1, 3});
    CHECK(cut.triangles[1] == Triangle{1, 2, 3});
}

TEST_CASE("a dart is cut at its notch, though the other diagonal is shorter", "[triangulate]") {
    const PolygonMesh dart = polygon({{0, 0, 0}, {4, -0.4, 0}, {3, 0, 0}, {4, 0.4, 0}});
    const auto [least, total] = areas(dart);
    CHECK(least > 0);
    CHECK(total == Approx(1.2));
}

TEST_CASE("polygons with notches are covered without overlap", "[triangulate]") {
    // A comb: no fan from any corner covers it.
    std::vector<Vec3> comb{{0, -1, 0}, {8, -1, 0}};
    for (int tooth = 7; tooth >= 0; --tooth) {
        comb.emplace_back(tooth + 1, 0, 0);
        comb.emplace_back(tooth + 0.5, 5, 0);
    }
    comb.emplace_back(0, 0, 0);
    const PolygonMesh mesh = polygon(comb);
    CHECK(triangulate(mesh).size() == comb.size() - 2);
    const auto [least, total] = areas(mesh);
    CHECK(least > 0);
    CHECK(total == Approx(8 + 8 * 2.5));
}

TEST_CASE("a polygon of n corners gives n - 2 triangles, whatever its shape", "[triangulate]") {
    for (std::size_t n : {0u, 1u, 2u, 3u, 4u, 5u, 9u, 100u}) {
        std::vector<Vec3> crossing, point(n, Vec3(1, 1, 1));
        for (std::size_t i = 0; i < n; ++i) {
            const auto t = static_cast<double>(i);
            crossing.emplace_back(std::cos(2.5 * t), std::sin(2.5 * t), std::sin(t)); // a star
        }
        CHECK(triangulate(polygon(crossing)).size() == (n < 3 ? 0 : n - 2));
        CHECK(triangulate(polygon(point)).size() == (n < 3 ? 0 : n - 2));
    }
}

TEST_CASE("triangles know their facet", "[triangulate]") {
    PolygonMesh mesh = polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 0.5, 0}});
    mesh.add_facet(std::array<Index, 2>{0, 1});
    mesh.add_facet(std::array<Index, 3>{0, 1, 2});
    const Triangulation cut = triangulate(mesh);
    CHECK(cut.first == std::vector<Index>{0, 3, 3, 4});
    CHECK(facet_of_triangle(cut) == std::vector<Index>{0, 0, 0, 2});
}

TEST_CASE("welding names equal positions by the first of them", "[weld]") {
    CHECK(weld({{0, 0, 0}, {1, 0, 0}, {-0.0, 0, 0}, {1, 1e-300, 0}, {1, 0, 0}})
          == std::vector<Index>{0, 1, 0, 3, 1});
    CHECK(weld({}).empty());
}
