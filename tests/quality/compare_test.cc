#include "hsdm/quality/compare.hh"

#include "hsdm/errors.hh"
#include "support/meshes.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

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

TEST_CASE("two clouds are as far apart as each point's nearest of the other", "[compare]") {
    const PolygonMesh a = cloud(1);
    PolygonMesh b;
    b.positions = support::sample(support::sphere(1.1), {.points = 300, .seed = 5}).positions;
    const auto distances = [](const PolygonMesh& from, const PolygonMesh& to) {
        std::vector<double> result;
        for (const Vec3& p : from.positions) {
            double least = 1e300;
            for (const Vec3& q : to.positions) least = std::min(least, (p - q).norm());
            result.push_back(least);
        }
        std::sort(result.begin(), result.end());
        return result;
    };
    const Comparison result = compare(a, b);
    for (const auto& [expected, found, percentiles] :
         {std::tuple(distances(a, b), result.a_to_b, result.a_to_b_percentiles),
          std::tuple(distances(b, a), result.b_to_a, result.b_to_a_percentiles)}) {
        double sum = 0, squares = 0;
        for (double d : expected) sum += d, squares += d * d;
        const std::size_t n = expected.size();
        CHECK(found.max == Approx(expected.back()));
        CHECK(found.mean == Approx(sum / static_cast<double>(n)));
        CHECK(found.rms == Approx(std::sqrt(squares / static_cast<double>(n))));
        CHECK(percentiles.median == Approx(expected[n / 2 - 1]));
        CHECK(percentiles.p95 == Approx(expected[n * 95 / 100 - 1]));
    }
    const Comparison by_points = compare(std::span(a.positions), std::span(b.positions));
    CHECK(by_points.a_to_b.rms == result.a_to_b.rms);
    CHECK(by_points.b_to_a.farthest == result.b_to_a.farthest);
    CHECK(by_points.diagonal == result.diagonal);
    CHECK(compare(std::span(a.positions), std::span(a.positions)).hausdorff() == 0);
    CHECK_THROWS_AS(compare(std::span(a.positions), std::span<const Vec3>()), Error);
}

TEST_CASE("two clouds of any size and place are compared", "[compare]") {
    const std::vector<Vec3> a = cloud(1).positions, b = cloud(1.25).positions;
    const Comparison one = compare(std::span(a), std::span(b));
    std::vector<Vec3> far_a = a, far_b = b;
    for (auto* points : {&far_a, &far_b})
        for (Vec3& p : *points) p += Vec3(1e7, -2e7, 3e7);
    const Comparison far = compare(std::span(far_a), std::span(far_b));
    CHECK(far.a_to_b.mean == Approx(one.a_to_b.mean).epsilon(1e-6));
    const double factor = std::ldexp(1.0, GENERATE(-990, -300, 130, 1000));
    for (Vec3& p : far_a) p = a[static_cast<std::size_t>(&p - far_a.data())] * factor;
    for (Vec3& p : far_b) p = b[static_cast<std::size_t>(&p - far_b.data())] * factor;
    const Comparison other = compare(std::span(far_a), std::span(far_b));
    CHECK(other.a_to_b.max == one.a_to_b.max * factor);
    CHECK(other.b_to_a_percentiles.p99 == one.b_to_a_percentiles.p99 * factor);
    CHECK(other.diagonal == one.diagonal * factor);
}
