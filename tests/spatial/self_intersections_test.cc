#include "hsdm/core/orientation.hh"
#include "hsdm/spatial/facet_cells.hh"
#include "hsdm/spatial/self_intersections.hh"
#include "hsdm/spatial/triangles_meet.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <cmath>
#include <random>

using namespace hsdm;

namespace {

/// Triangles over their own vertices, three positions each.
PolygonMesh triangles(const std::vector<Vec3>& corners) {
    PolygonMesh mesh;
    mesh.positions = corners;
    for (Index v = 0; v + 2 < corners.size(); v += 3) mesh.add_facet(std::array<Index, 3>{v, v + 1, v + 2});
    return mesh;
}

std::size_t pairs(const PolygonMesh& mesh) {
    return find_self_intersections(mesh).triangle_pairs;
}

/// Sign of the same determinant in whole numbers.
int integer_orientation(const std::array<std::array<long, 3>, 4>& p) {
    std::array<std::array<__int128, 3>, 3> m;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) m[i][k] = p[i + 1][k] - p[0][k];
    const __int128 d = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
                       - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
                       + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    return (d > 0) - (d < 0);
}

} // namespace

TEST_CASE("orientation agrees with whole-number arithmetic, near and on the plane", "[self_intersections]") {
    std::mt19937_64 random(1);
    std::uniform_int_distribution<long> small(-3, 3), large(-(1l << 40), 1l << 40);
    std::size_t wrong = 0, coplanar = 0;
    for (int i = 0; i < 4000; ++i) {
        // Multiples of one another plus a little: determinants far below the rounding of their terms.
        std::array<std::array<long, 3>, 4> p;
        for (std::size_t k = 0; k < 3; ++k) {
            const long u = large(random) / 8, v = large(random) / 8;
            p[0][k] = large(random);
            p[1][k] = p[0][k] + u;
            p[2][k] = p[0][k] + v;
            p[3][k] = p[0][k] + u + v + (i % 3 == 0 ? 0 : small(random));
        }
        std::array<Vec3, 4> q;
        for (std::size_t j = 0; j < 4; ++j)
            for (unsigned k = 0; k < 3; ++k) q[j][k] = static_cast<double>(p[j][k]) * 0x1p-20;
        const int expected = integer_orientation(p);
        wrong += orientation(q[0], q[1], q[2], q[3]) != expected;
        wrong += orientation(q[1], q[0], q[2], q[3]) != -expected;
        coplanar += expected == 0;
    }
    CHECK(wrong == 0);
    CHECK(coplanar > 1000);
}

TEST_CASE("orientation in the plane sees one unit in the last place", "[self_intersections]") {
    const Vec2 a{0.5, 0.5}, b{12, 12};
    double y = 24;
    CHECK(orientation(a, b, Vec2{24, y}) == 0);
    CHECK(orientation(a, b, Vec2{24, std::nextafter(y, 25)}) == 1);
    CHECK(orientation(a, b, Vec2{24, std::nextafter(y, 23)}) == -1);
}

TEST_CASE("triangles that pass through, touch, or stay apart are told apart", "[self_intersections]") {
    const std::vector<Vec3> floor{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    auto with = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        std::vector<Vec3> corners = floor;
        corners.insert(corners.end(), {a, b, c});
        return pairs(triangles(corners));
    };
    CHECK(with({1, 1, -1}, {1, 1, 1}, {9, 9, 1}) == 1);      // a side goes through the floor
    CHECK(with({-1, 1, 1}, {9, 1, 1}, {1, 1, -9}) == 1);     // the floor's sides go through it
    CHECK(with({1, 1, 0}, {1, 2, 1}, {2, 1, 1}) == 1);       // stands on a tip
    CHECK(with({2, 2, 0}, {5, 5, 1}, {5, 6, 1}) == 1);       // touches the floor's rim
    CHECK(with({1, 1, 1e-300}, {1, 2, 1}, {2, 1, 1}) == 0);  // a hair above
    CHECK(with({5, 5, 0}, {6, 5, 0}, {5, 6, 0}) == 0);       // in the same plane, beside
    CHECK(with({1, 1, 0}, {2, 1, 0}, {1, 2, 0}) == 1);       // in the same plane, inside
    CHECK(with({-9, -9, 0}, {30, -9, 0}, {-9, 30, 0}) == 1); // in the same plane, around
    CHECK(with({1, 1, 1}, {2, 1, 1}, {1, 2, 1}) == 0);
}

TEST_CASE("neighbours do not intersect in what they share", "[self_intersections]") {
    const std::vector<Vec3> p{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5}, {2, 0, 0.3}};
    PolygonMesh mesh;
    mesh.positions = p;
    mesh.add_facet(std::array<Index, 3>{0, 1, 2});
    mesh.add_facet(std::array<Index, 3>{0, 2, 3});
    mesh.add_facet(std::array<Index, 3>{1, 4, 2});
    CHECK(pairs(mesh) == 0);
    // The same without shared indices: equal positions are shared all the same.
    CHECK(pairs(triangles({p[0], p[1], p[2], p[0], p[2], p[3], p[1], p[4], p[2]})) == 0);
}

TEST_CASE("an edge folded flat and a vertex fan folded over are intersections", "[self_intersections]") {
    CHECK(pairs(triangles({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 0}, {1, 1, 0}})) == 1);
    CHECK(pairs(triangles({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 0}, {1, 1, -1}, {1, 1, 1}})) == 1);
    CHECK(pairs(triangles({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 0}, {1, 1, 0}, {3, 1, 0}})) == 1);
    CHECK(pairs(triangles({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 0}, {-1, -1, 0}, {-1, 1, -3}})) == 0);
    CHECK(pairs(triangles({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}})) == 1);
}

TEST_CASE("facets involved are listed once, in order, a folded quad with itself", "[self_intersections]") {
    PolygonMesh mesh;
    mesh.positions = {{0, 0, 0},  {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, -1},
                      {3, 3, -1}, {3, 3, 1}, {1, 1, 1}, {9, 9, 9}};
    mesh.add_facet(std::array<Index, 4>{4, 5, 6, 7}); // stands in the next one, across its cut
    mesh.add_facet(std::array<Index, 4>{0, 1, 2, 3});
    mesh.add_facet(std::array<Index, 3>{8, 8, 0});
    const SelfIntersections found = find_self_intersections(mesh);
    REQUIRE(found.facet_pairs.size() == 1);
    CHECK(found.facet_pairs[0] == std::array<Index, 2>{0, 1});
    CHECK(found.triangle_pairs > 1);
    CHECK(found.skipped == 1);

    PolygonMesh folded;
    folded.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    folded.add_facet(std::array<Index, 4>{0, 2, 1, 3}); // crosses itself: both cuts fold it
    const SelfIntersections self = find_self_intersections(folded);
    CHECK(self.facet_pairs == std::vector<std::array<Index, 2>>{{0, 0}});
}

TEST_CASE("the tree misses no pair and finds none twice", "[self_intersections]") {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<Vec3> corners;
    for (int i = 0; i < 500; ++i) {
        const Vec3 middle(2 * unit(random), unit(random), unit(random));
        for (int k = 0; k < 3; ++k)
            corners.push_back(middle + Vec3(unit(random), unit(random), unit(random)) * 0.3);
    }
    const PolygonMesh mesh = triangles(corners);
    std::vector<std::array<Index, 2>> expected;
    auto placed = [&](Index t) {
        return PlacedTriangle{{corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]},
                              {3 * t, 3 * t + 1, 3 * t + 2}};
    };
    for (Index a = 0; a < 500; ++a)
        for (Index b = a + 1; b < 500; ++b)
            if (triangles_meet(placed(a), placed(b))) expected.push_back({a, b});
    CHECK(expected.size() > 100);
    const SelfIntersections found = find_self_intersections(mesh);
    CHECK(found.facet_pairs == expected);
    CHECK(found.triangle_pairs == expected.size());
    tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    CHECK(find_self_intersections(mesh).facet_pairs == expected);
}

TEST_CASE("meeting does not depend on which triangle is named first, nor on the order of corners",
          "[self_intersections]") {
    std::mt19937_64 random(4);
    std::uniform_int_distribution<int> grid(0, 2); // many corners coincide, many triangles are coplanar
    std::size_t differing = 0, meeting = 0;
    for (int i = 0; i < 5000; ++i) {
        PlacedTriangle t[2];
        for (auto& triangle : t)
            for (std::size_t k = 0; k < 3; ++k) {
                const int x = grid(random), y = grid(random), z = grid(random);
                triangle.corner[k] = Vec3(x, y, z);
                triangle.vertex[k] = static_cast<Index>(x + 3 * y + 9 * z);
            }
        if (is_collinear(t[0].corner) || is_collinear(t[1].corner)) continue;
        const bool meet = triangles_meet(t[0], t[1]);
        meeting += meet;
        PlacedTriangle turned = t[0];
        std::swap(turned.corner[0], turned.corner[2]);
        std::swap(turned.vertex[0], turned.vertex[2]);
        differing += triangles_meet(t[1], t[0]) != meet || triangles_meet(turned, t[1]) != meet
                     || triangles_meet(t[1], turned) != meet;
    }
    CHECK(differing == 0);
    CHECK(meeting > 500);
}

TEST_CASE("an empty mesh does not intersect itself", "[self_intersections]") {
    CHECK(pairs(PolygonMesh{}) == 0);
}

TEST_CASE("cells leave out no facets that intersect", "[self_intersections]") {
    std::size_t meeting = 0, clear = 0;
    for (unsigned seed = 0; seed < 60; ++seed) {
        std::mt19937_64 random(seed);
        const double rough = 0.02 * seed;
        std::uniform_real_distribution<double> off(-rough, rough);
        constexpr Index side = 9;
        PolygonMesh mesh; // two sheets of quads above each other, one facet in ten missing
        for (int sheet = 0; sheet < 2; ++sheet)
            for (Index i = 0; i < side * side; ++i)
                mesh.positions.push_back(Vec3(0.1 + i % side, 0.3 + i / side, sheet)
                                         + Vec3(off(random), off(random), off(random)));
        for (Index v = 0; v + side + 1 < mesh.vertex_count(); ++v)
            if (v % side + 1 < side && v % (side * side) < side * (side - 1) && random() % 10 > 0)
                mesh.add_facet(std::array{v, v + 1, v + side + 1, v + side});
        if (seed % 3 == 0) mesh.add_facet(std::array<Index, 5>{0, 1, 2, side + 2, side}); // beside others
        const SelfIntersections all = find_self_intersections(mesh);
        (all.facet_pairs.empty() ? clear : meeting) += 1;
        for (const double cell : {1.2, 1.6, 2.1}) {
            const FacetCells cells(mesh, cell);
            CHECK(cells.usable());
            const SelfIntersections found = find_self_intersections(mesh, cells);
            CHECK(found.facet_pairs == all.facet_pairs);
            CHECK(found.triangle_pairs == all.triangle_pairs);
            CHECK(found.skipped == all.skipped);
        }
    }
    CHECK(meeting > 20);
    CHECK(clear > 5);
}
