#include "hsdm/simplify/facet_field.hh"
#include "simplify/grids.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <numbers>

using namespace hsdm;
using support::arc;
using support::grid;

namespace {

constexpr double degree = std::numbers::pi / 180;

/// A row of quads along x, bent by an angle behind one of them.
PolygonMesh bent_row(Index facets, Index bend_behind, double angle) {
    PolygonMesh mesh;
    Vec3 at(0, 0, 0);
    for (Index i = 0; i <= facets; ++i) {
        mesh.positions.push_back(at);
        mesh.positions.push_back(at + Vec3(0, 1, 0));
        const double turn = i > bend_behind ? angle : 0;
        at += Vec3(std::cos(turn), 0, -std::sin(turn));
    }
    for (Index i = 0; i < facets; ++i) mesh.add_facet(std::array{2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1});
    return mesh;
}

/// How many facets lie beside one, over no sharp edge.
int beside(const FacetField& field, Index facet) {
    int count = 0;
    field.for_beside(facet, [&](Index) { ++count; });
    return count;
}

} // namespace

TEST_CASE("a sum of normals has their mean and how they vary about it", "[simplify]") {
    NormalSum sum;
    sum.add({1, 0, 0}, 1);
    sum.add({0, 1, 0}, 3);
    CHECK((sum.mean() - Vec3(0.25, 0.75, 0)).norm() < 1e-12);
    // About the mean they vary by sqrt(2) * sqrt(3) / 4 between each other, and else not at all.
    CHECK(sum.deviation()[2] == Approx(std::sqrt(6.0) / 4));
    CHECK(sum.deviation()[1] == Approx(0).margin(1e-4));
    const Variation variation = sum.about_mean();
    CHECK(std::abs(variation.direction[2] | Vec3(1, -1, 0)) == Approx(std::sqrt(2.0)));
    const Variation about_zero = sum.about_zero();
    CHECK(about_zero.deviation[0] == Approx(0).margin(1e-4));
    CHECK(about_zero.deviation[2] == Approx(std::sqrt(0.75)));
    CHECK(std::abs(about_zero.direction[0][2]) == Approx(1));
}

TEST_CASE("sums of normals add up, and none of weight are zero", "[simplify]") {
    support::Random random(1);
    NormalSum first, second, all;
    for (int i = 0; i < 20; ++i) {
        const Vec3 normal = random.direction();
        const double weight = random.uniform();
        (i % 2 ? first : second).add(normal, weight);
        all.add(normal, weight);
    }
    first += second;
    CHECK((first.mean() - all.mean()).norm() < 1e-12);
    for (std::size_t k = 0; k < 3; ++k) CHECK(first.deviation()[k] == Approx(all.deviation()[k]));
    CHECK(NormalSum().mean() == Vec3(0, 0, 0));
    CHECK(NormalSum().deviation() == std::array<double, 3>{0, 0, 0});
}

TEST_CASE("flat ground does not bend, and a facet there has those across its sides beside it", "[simplify]") {
    const PolygonMesh mesh = grid(12, 8, [](double u, double v) { return Vec3(3 * u, 2 * v, 0.5); });
    const FacetField field = facet_field(mesh);
    REQUIRE(field.size() == 96);
    int links = 0;
    for (Index f = 0; f < field.size(); ++f) {
        CHECK(field.spread[f] < 1e-7);
        CHECK((field.normal[f] - Vec3(0, 0, 1)).norm() < 1e-12);
        CHECK((field.mean_normal[f] - Vec3(0, 0, 1)).norm() < 1e-12);
        links += beside(field, f);
        field.for_beside(f,
                         [&](Index g) { CHECK(((g + 1 == f || f + 1 == g) || g + 12 == f || f + 12 == g)); });
    }
    CHECK(links == 2 * (11 * 8 + 12 * 7));
    double area = 0;
    for (const Vec3& vector : field.area) area += vector.norm();
    CHECK(area == Approx(2 * 6));
    CHECK(facet_field(PolygonMesh()).size() == 0);
}

TEST_CASE("a bend is felt by facets up to three sides away", "[simplify]") {
    const PolygonMesh mesh = bent_row(12, 5, 10 * degree);
    const FacetField field = facet_field(mesh);
    for (Index f = 0; f < 12; ++f) {
        INFO("facet " << f);
        CHECK((field.spread[f] > 1e-3) == (f >= 3 && f <= 8));
        CHECK(field.next_spread[f] < 1e-4);
    }
    CHECK(field.spread[5] > field.spread[4]); // the near ones count most
    CHECK(field.spread[4] > field.spread[3]);
}

TEST_CASE("a sharp edge is where a neighbourhood ends", "[simplify]") {
    for (const double angle : {25 * degree, 27 * degree}) {
        INFO(angle / degree << " degrees");
        const bool is_sharp = angle > 26 * degree;
        const PolygonMesh mesh = bent_row(12, 5, angle);
        const FacetField field = facet_field(mesh);
        CHECK(beside(field, 5) == (is_sharp ? 1 : 2));
        CHECK((field.spread[5] > 1e-3) == !is_sharp);
        CHECK((field.mean_normal[5] - Vec3(0, 0, 1)).norm() < (is_sharp ? 1e-12 : 0.5));
    }
}

TEST_CASE("a cylinder bends one way only, to the side that its facets face or away", "[simplify]") {
    const PolygonMesh mesh = arc(1, 1.8, 0, 60, 30);
    for (const bool inside : {false, true}) {
        const PolygonMesh turned = inside ? support::reversed(mesh) : mesh;
        const FacetField field = facet_field(turned);
        std::size_t wrong = 0;
        for (Index f = 0; f < field.size(); ++f) {
            wrong += (field.convex[f] != 0) == inside;
            wrong += field.spread[f] < 0.02 || field.next_spread[f] > 0.1 * field.spread[f];
            wrong += std::abs(field.around[f].about_zero().direction[0][1]) < 0.99;
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("a ball bends either way alike", "[simplify]") {
    const PolygonMesh mesh = grid(30, 30, [](double u, double v) {
        const double x = u - 0.5, y = v - 0.5;
        return Vec3(x, y, std::sqrt(1.5 - x * x - y * y));
    });
    const FacetField field = facet_field(mesh);
    for (Index r = 4; r < 26; ++r)
        for (Index c = 4; c < 26; ++c) CHECK(field.next_spread[30 * r + c] > 0.5 * field.spread[30 * r + c]);
}

TEST_CASE("the field does not depend on the number of threads", "[simplify]") {
    const PolygonMesh mesh = arc(1, 2.5, 0.3, 100, 50);
    const FacetField many = facet_field(mesh);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const FacetField single = facet_field(mesh);
    CHECK(many.beside == single.beside);
    CHECK(many.mean_normal == single.mean_normal);
    CHECK(many.spread == single.spread);
    CHECK(many.next_spread == single.next_spread);
    CHECK(many.convex == single.convex);
}
