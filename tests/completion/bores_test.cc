#include "hsdm/completion/bores.hh"
#include "hsdm/mesh/remove_facets.hh"
#include "support/meshes.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <numbers>

using namespace hsdm;
using support::Random;

namespace {

constexpr double length = 8;

/// The wall of a bore about the z axis, 8 long, which faces the axis; without the facets that `gone` holds of
/// at all corners. A cone with that sine, if any.
template <class Gone>
PolygonMesh bore(double radius, const Gone& gone, double slope = 0) {
    PolygonMesh mesh = support::quad_tube(60, 80, [&](Index c, Index r) {
        const double turn = 2 * std::numbers::pi * c / 60, z = length * (r / 80.0 - 0.5);
        const double wide = radius + slope * z;
        return Vec3(wide * std::cos(turn), -wide * std::sin(turn), z);
    });
    remove_facets(mesh, [&](std::size_t f) {
        return std::ranges::all_of(mesh.facet(f), [&](Index v) { return gone(mesh.positions[v]); });
    });
    return mesh;
}

Bores bores_of(const PolygonMesh& mesh) {
    return find_bores(mesh, boundary_loops(mesh), 0.2);
}

/// Two halves of a bore, the second one moved and made wider.
PolygonMesh two_halves(double aside, double wider) {
    PolygonMesh mesh = bore(1, [](const Vec3& p) { return std::abs(p[2]) < 1.6; });
    for (Vec3& p : mesh.positions)
        if (p[2] > 0) p = Vec3(p[0] * wider + aside, p[1] * wider, p[2]);
    return mesh;
}

double area_of(const PolygonMesh& triangles) {
    double area = 0;
    for (std::size_t f = 0; f < triangles.facet_count(); ++f) {
        const auto t = triangles.facet(f);
        const Vec3& p = triangles.positions[t[0]];
        area += 0.5 * ((triangles.positions[t[1]] - p) % (triangles.positions[t[2]] - p)).norm();
    }
    return area;
}

/// Facing the axis, on the wall of the bore, and as much of it as is missing.
void check_walls(const PolygonMesh& walls, double radius, double missing) {
    for (std::size_t f = 0; f < walls.facet_count(); ++f) {
        const auto t = walls.facet(f);
        const Vec3 &p = walls.positions[t[0]], &q = walls.positions[t[1]], &r = walls.positions[t[2]];
        if (((q - p) % (r - p)).norm() < 1e-3) continue; // beside notches; nothing is made of those
        const Vec3 middle = (p + q + r) / 3;
        const Vec3 inward = -Vec3(middle[0], middle[1], 0).normalized();
        CHECK((((q - p) % (r - p)).normalized() | inward) > 0.9);
        for (const Vec3& at : {p, q, r}) {
            CHECK(std::hypot(at[0], at[1]) < 1.0001 * radius);
            CHECK(std::hypot(at[0], at[1]) > 0.97 * radius);
        }
    }
    CHECK(area_of(walls) == Approx(missing).epsilon(0.02));
}

} // namespace

TEST_CASE("two ends of a bore are joined by its wall, ragged and slanted as they may be", "[completion]") {
    Random random(5);
    for (int round = 0; round < 4; ++round) {
        const double radius = random.uniform(0.4, 1.2), half = random.uniform(0.5, 3);
        const double slant = random.uniform(-0.4, 0.4), ragged = random.uniform(0, 0.25);
        const PolygonMesh mesh = bore(radius, [&](const Vec3& p) {
            const double notch = ragged * std::sin(9 * std::atan2(p[1], p[0]));
            return std::abs(p[2] - slant * p[0]) < half + notch;
        });
        const Bores bores = bores_of(mesh);
        CHECK(bores.loops.size() == 2); // the far ends lead away from each other
        check_walls(bores.walls, radius,
                    2 * std::numbers::pi * radius * length - area_of(support::cut_in_two(mesh)));
    }
}

TEST_CASE("a bore of whose wall a strip was seen is closed from end to end beside it", "[completion]") {
    const auto gone = [](double seen) {
        return
            [seen](const Vec3& p) { return std::abs(p[2]) < 2.2 && std::abs(std::atan2(p[1], p[0])) > seen; };
    };
    const PolygonMesh strip = bore(1, gone(0.3));
    const Bores bores = bores_of(strip);
    REQUIRE(bores.loops.size() == 1);
    check_walls(bores.walls, 1, 2 * std::numbers::pi * length - area_of(support::cut_in_two(strip)));
    CHECK(bores_of(bore(1, gone(2.6))).loops.empty()); // a hole in the wall is none
}

TEST_CASE("a bore with a strip seen is found wherever its border begins", "[completion][slow]") {
    for (const double slope : {0.0, 0.15})
        for (const double turn : {0.0, 0.7, 1.4, 2.1, 2.8, -0.7, -1.4, -2.1, -2.8}) {
            INFO("slope " << slope << ", strip at " << turn);
            const PolygonMesh strip = bore(
                2,
                [&](const Vec3& p) {
                    const double aside = std::remainder(std::atan2(p[1], p[0]) - turn, 2 * std::numbers::pi);
                    return std::abs(p[2]) < 2.2 && std::abs(aside) > 0.3;
                },
                slope);
            CHECK(bores_of(strip).loops.size() == 1);
        }
}

TEST_CASE("ends between which scanners looked through the wall are two holes", "[completion]") {
    const PolygonMesh mesh = two_halves(0, 1);
    const auto found = [&](const std::function<bool(const Vec3&)>& empty) {
        return find_bores(mesh, boundary_loops(mesh), 0.2, empty).loops.size();
    };
    CHECK(found([](const Vec3& p) { return std::hypot(p[0], p[1]) < 0.9; }) == 2); // through the bore
    CHECK(found([](const Vec3& p) { return std::abs(p[2]) < 0.2; }) == 2);         // past an edge of it
    CHECK(found([](const Vec3& p) { return std::abs(p[2]) < 1.2; }) == 0);
}

TEST_CASE("what does not go on to each other is no bore", "[completion]") {
    CHECK(bores_of(two_halves(0, 1)).loops.size() == 2);
    CHECK(bores_of(two_halves(0.4, 1)).loops.empty());
    CHECK(bores_of(two_halves(0, 1.4)).loops.empty());
    const auto middle = [](const Vec3& p) { return std::abs(p[2]) < 1.6; };
    CHECK(bores_of(bore(4, middle, 0.1)).loops.size() == 2);
    CHECK(bores_of(bore(4, middle, 0.6)).loops.empty()); // a funnel
    CHECK(bores_of(support::round_tube(60, 20, 1, 0.1)).loops.empty());
    PolygonMesh rod = bore(1, middle);
    for (std::size_t f = 0; f < rod.facet_count(); ++f)
        std::reverse(rod.corners.begin() + rod.first[f], rod.corners.begin() + rod.first[f + 1]);
    CHECK(bores_of(rod).loops.empty());
}

TEST_CASE("of several ends on one axis the nearest belong together", "[completion]") {
    // Two gaps; the outermost ends point at each other as well.
    const PolygonMesh mesh = bore(0.5, [](const Vec3& p) { return std::abs(std::abs(p[2]) - 2.6) < 0.5; });
    const Bores bores = bores_of(mesh);
    CHECK(bores.loops.size() == 4);
    CHECK(bores.walls.facet_count() > 0);
    for (const Vec3& p : bores.walls.positions) CHECK(std::abs(p[2]) > 2);
}
