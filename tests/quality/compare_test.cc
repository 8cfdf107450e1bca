#include "hsdm/quality/compare.hh"

#include "hsdm/errors.hh"
#include "support/meshes.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace hsdm;
using support::tetrahedron;

namespace {

PolygonMesh cloud(double size) {
    PolygonMesh points;
    points.positions = support::sample(support::sphere(1), {.points = 500}).positions;
    for (Vec3& p : points.positions) p *= size;
    return points;
}

} // namespace

TEST_CASE("what is compared may have any size", "[compare]") {
    const Comparison one = compare(tetrahedron(1), cloud(1));
    const double factor = std::ldexp(1.0, GENERATE(-1000, -300, 130, 665, 1000));
    const Comparison other = compare(tetrahedron(factor), cloud(factor));
    CHECK(other.a_to_b.max == one.a_to_b.max * factor);
    CHECK(other.a_to_b.rms == one.a_to_b.rms * factor);
    CHECK(other.b_to_a.mean == one.b_to_a.mean * factor);
    CHECK(other.diagonal == one.diagonal * factor);
}

TEST_CASE("what is out of reach of double precision is refused", "[compare]") {
    const double factor = std::ldexp(1.0, GENERATE(-1010, 1022));
    CHECK_THROWS_AS(compare(tetrahedron(factor), cloud(factor / 2)), Error);
}

TEST_CASE("a mesh without area is measured by its vertices", "[compare]") {
    PolygonMesh line;
    line.positions = {Vec3(0, 0, 3), Vec3(0.1, 0, 3), Vec3(0.2, 0, 5)};
    line.add_facet(std::array<Index, 3>{0, 1, 0});
    line.add_facet(std::array<Index, 3>{1, 2, 2});
    PolygonMesh ground = tetrahedron(1);
    for (Vec3& p : ground.positions) p[2] *= 1e-9;
    const Comparison result = compare(line, ground);
    CHECK(result.a_to_b.max == Approx(5));
    CHECK(result.a_to_b.mean == Approx(11.0 / 3));
    CHECK(result.a_to_b.rms == Approx(std::sqrt(43.0 / 3)));
}

TEST_CASE("coordinates that are not finite are refused", "[compare]") {
    PolygonMesh broken = cloud(1);
    broken.positions[3][1] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(compare(tetrahedron(1), broken), Error);
}
