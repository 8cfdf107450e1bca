#include "hsdm/quality/distance_to_surface.hh"
#include "hsdm/spatial/facet_cells.hh"
#include "hsdm/spatial/mesh_distance.hh"
#include "hsdm/spatial/self_intersections.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <cmath>
#include <random>

using namespace hsdm;

namespace {

using Real = long double;

Real segment_squared(const std::array<Real, 3>& p, const std::array<Real, 3>& a,
                     const std::array<Real, 3>& b) {
    Real length = 0, along = 0, squared = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        length += (b[k] - a[k]) * (b[k] - a[k]);
        along += (p[k] - a[k]) * (b[k] - a[k]);
    }
    const Real t = length > 0 ? std::clamp<Real>(along / length, 0, 1) : 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Real d = p[k] - a[k] - t * (b[k] - a[k]);
        squared += d * d;
    }
    return squared;
}

/// Slow and plain: the plane where the foot lies inside all three sides, else the sides.
Real triangle_distance(const Vec3& point, const Vec3& va, const Vec3& vb, const Vec3& vc) {
    auto real = [](const Vec3& v) { return std::array<Real, 3>{v[0], v[1], v[2]}; };
    const std::array<Real, 3> p = real(point), a = real(va), b = real(vb), c = real(vc);
    Real squared = std::min({segment_squared(p, a, b), segment_squared(p, b, c), segment_squared(p, c, a)});
    auto minus = [](const auto& x, const auto& y) {
        return std::array<Real, 3>{x[0] - y[0], x[1] - y[1], x[2] - y[2]};
    };
    auto cross = [](const auto& x, const auto& y) {
        return std::array<Real, 3>{x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2],
                                   x[0] * y[1] - x[1] * y[0]};
    };
    auto dot = [](const auto& x, const auto& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; };
    const auto n = cross(minus(b, a), minus(c, a));
    const Real nn = dot(n, n);
    const bool inside = nn > 0 && dot(n, cross(minus(b, a), minus(p, a))) >= 0
                        && dot(n, cross(minus(c, b), minus(p, b))) >= 0
                        && dot(n, cross(minus(a, c), minus(p, c))) >= 0;
    if (inside) squared = std::min(squared, dot(n, minus(p, a)) * dot(n, minus(p, a)) / nn);
    return std::sqrt(squared);
}

Real brute_force(const Vec3& point, const PolygonMesh& mesh) {
    Real least = std::numeric_limits<Real>::infinity();
    for (const Triangle& t : triangulate(mesh).triangles)
        least = std::min(least, triangle_distance(point, mesh.positions[t[0]], mesh.positions[t[1]],
                                                  mesh.positions[t[2]]));
    return least;
}

/// Triangles of all sizes and shapes, some of them degenerate, around `centre`.
PolygonMesh random_triangles(std::size_t n, unsigned seed, const Vec3& centre = {0, 0, 0}) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    auto vector = [&] { return Vec3(unit(random), unit(random), unit(random)); };
    PolygonMesh mesh;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 middle = centre + vector();
        const double size = std::pow(10, 2 * unit(random) - 2);
        const Vec3 side = size * vector();
        const Vec3 corners[] = {middle, middle + side,
                                i % 7 == 0   ? middle + side * unit(random) // on a line
                                : i % 7 == 1 ? middle                       // two corners equal
                                             : middle + size * vector()};
        std::array<Index, 3> facet;
        for (std::size_t k = 0; k < 3; ++k) {
            facet[k] = static_cast<Index>(mesh.positions.size());
            mesh.positions.push_back(corners[k]);
        }
        mesh.add_facet(facet);
    }
    return mesh;
}

std::vector<Vec3> random_points(std::size_t n, unsigned seed, double size, const Vec3& centre = {0, 0, 0}) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> coordinate(-size, size);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < n; ++i)
        points.push_back(centre + Vec3(coordinate(random), coordinate(random), coordinate(random)));
    return points;
}

} // namespace

TEST_CASE("the tree finds the same distance as every triangle in turn", "[distance]") {
    for (std::size_t triangles : {1u, 2u, 5u, 16u, 17u, 70u, 1500u}) {
        const PolygonMesh mesh = random_triangles(triangles, static_cast<unsigned>(triangles));
        const MeshDistance distance(mesh);
        Real worst = 0;
        for (const Vec3& p : random_points(200, 5, 1.5)) {
            const Real expected = brute_force(p, mesh);
            worst = std::max(worst, std::abs(distance(p) - expected) / expected);
        }
        CHECK(static_cast<double>(worst) < 1e-12);
    }
}

TEST_CASE("points far outside the mesh and points on it are measured exactly", "[distance]") {
    const PolygonMesh mesh = random_triangles(300, 3);
    const MeshDistance distance(mesh);
    for (const Vec3& p : random_points(50, 6, 1e6)) {
        const Real expected = brute_force(p, mesh);
        CHECK(std::abs(static_cast<double>((distance(p) - expected) / expected)) < 1e-12);
    }
    for (const Vec3& p : mesh.positions) CHECK(distance(p) < 1e-15);
}

TEST_CASE("a mesh far from the origin keeps its small distances", "[distance]") {
    const Vec3 far(4e6, -7e6, 1e7);
    const PolygonMesh mesh = random_triangles(300, 4, far);
    const MeshDistance distance(mesh);
    Real worst = 0;
    for (const Vec3& p : random_points(200, 7, 1.5, far))
        worst = std::max(worst, std::abs(distance(p) - brute_force(p, mesh)));
    CHECK(static_cast<double>(worst) < 1e-8); // coordinates of 1e7 are themselves rounded to 2e-9
}

TEST_CASE("many points give the largest, mean and rms distance and the farthest point", "[distance]") {
    const PolygonMesh mesh = random_triangles(100, 8);
    const std::vector<Vec3> points = random_points(5000, 9, 2);
    const MeshDistance single(mesh);
    double max = 0, sum = 0, squares = 0;
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double d = single(points[i]);
        sum += d;
        squares += d * d;
        if (d > max) max = d, farthest = i;
    }
    const Distance distance = points_to_mesh(points, mesh);
    CHECK(distance.max == max); // a start elsewhere in the tree changes no distance
    CHECK(distance.farthest == farthest);
    CHECK(distance.mean == Approx(sum / 5000).epsilon(1e-12));
    CHECK(distance.rms == Approx(std::sqrt(squares / 5000)).epsilon(1e-12));
    for (const double bound : {0.5 * max, std::nextafter(max, 0), max, 2 * max})
        CHECK((points_to_mesh(points, mesh, {.enough = bound}).max > bound) == (max > bound));
}

TEST_CASE("points in each other's neighbourhood are measured as if each were alone", "[distance]") {
    const PolygonMesh mesh = random_triangles(4000, 12);
    const MeshDistance single(mesh);
    for (const double step : {1e-4, 1e-3, 1e-2, 0.1, 1.0}) {
        std::vector<Vec3> walk{Vec3(0, 0, 0)};
        for (const Vec3& way : random_points(1999, 13, step)) {
            walk.push_back(walk.back() + way);
            if (walk.back().norm() > 1.5) walk.back() = -walk.back(); // and a jump now and then
        }
        double sum = 0, max = 0;
        for (const Vec3& p : walk) {
            sum += single(p);
            max = std::max(max, single(p));
        }
        const Distance distance = points_to_mesh(walk, mesh);
        CHECK(distance.mean == sum / 2000); // to the bit: so few are summed in order
        CHECK(distance.max == max);
    }
}

TEST_CASE("points that rounding alone keeps off a triangle are found on it, alone and together",
          "[distance]") {
    PolygonMesh mesh; // two open pieces, one of which ends in the centre of both
    mesh.positions = {{1, 0, 0}, {0, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, 1, 0}, {-1, 1, 1}};
    for (int copy = 0; copy < 4; ++copy) mesh.add_facet(std::array<Index, 3>{0, 1, 2});
    for (int copy = 0; copy < 4; ++copy) mesh.add_facet(std::array<Index, 3>{3, 4, 5});
    for (const double off : {-1e-15, -6.1e-17, -1e-17, 0.0, 1e-17}) {
        const std::vector<Vec3> points(20, Vec3(off, 0, 0));
        CHECK(points_to_mesh(points, mesh).max <= 2e-15);
        CHECK(MeshDistance(mesh)(points[0]) <= 2e-15);
        Index hint = no_index;
        CHECK(!MeshDistance(mesh).is_beyond(points[0], 2e-15, hint));
    }
}

TEST_CASE("a triangle near enough is found just where there is one, wherever the search begins",
          "[distance]") {
    for (const std::size_t triangles : {1u, 5u, 17u, 70u, 1500u}) {
        const PolygonMesh mesh = random_triangles(triangles, 15);
        const MeshDistance distance(mesh);
        Index hint = no_index;
        for (const Vec3& p : random_points(500, 16, 1.5)) { // none near the one before
            const double least = distance(p);
            const Index found = distance.triangle_within(p, 1.000001 * least, hint);
            REQUIRE(found != no_index);
            const auto ring = mesh.facet(found);
            CHECK(static_cast<double>(triangle_distance(p, mesh.positions[ring[0]], mesh.positions[ring[1]],
                                                        mesh.positions[ring[2]]))
                  < 1.000002 * least);
            CHECK(distance.is_beyond(p, 0.999999 * least, hint));
            CHECK(distance(p, hint) == least);
            Index none = no_index;
            CHECK(!distance.is_beyond(p, 1.000001 * least, none));
        }
    }
}

TEST_CASE("a stray far from a mesh, or of it, takes no digit from the others", "[distance]") {
    for (const double far : {1e6, 1e12, 1e30}) {
        PolygonMesh mesh = random_triangles(300, 21);
        const MeshDistance without(mesh);
        const std::vector<Vec3> points = random_triangles(200, 22).positions;
        std::vector<double> expected;
        for (const Vec3& p : points) expected.push_back(without(p));
        const auto first = static_cast<Index>(mesh.vertex_count());
        for (int i = 0; i < 3; ++i) mesh.positions.push_back(Vec3(far, 0.1 * far * i, -far));
        mesh.add_facet(std::array<Index, 3>{first, first + 1, first + 2});
        const MeshDistance with(mesh);
        for (std::size_t i = 0; i < points.size(); ++i)
            CHECK(with(points[i])
                  == Approx(expected[i]).margin(1e-15 * far)); // of the centre between the two
        CHECK(with(Vec3(far, 0, -far)) <= 1e-15 * far);
        CHECK(without(Vec3(far, 0, 0)) == Approx(far).epsilon(1e-4));
    }
}

TEST_CASE("coordinates that are not finite are near nothing and read nothing that is not there",
          "[distance]") {
    const MeshDistance distance(random_triangles(17, 23));
    constexpr double inf = std::numeric_limits<double>::infinity();
    for (const Vec3& p : {Vec3(inf, 0, 0), Vec3(0, -inf, inf), Vec3(std::nan(""), 0, 0)})
        CHECK(distance(p) == inf);
}

TEST_CASE("a point so far away that floats overflow has its distance", "[distance]") {
    for (const std::size_t triangles : {3u, 70u, 2000u}) {
        const PolygonMesh mesh = random_triangles(triangles, 14);
        const std::vector<Vec3> points(20, Vec3(1e20, 0, 0));
        CHECK(MeshDistance(mesh)(points[0]) == Approx(1e20));
        CHECK(points_to_mesh(points, mesh).max == Approx(1e20));
    }
}

TEST_CASE("distances are the same bits with one thread and with many", "[distance]") {
    const PolygonMesh mesh = random_triangles(20000, 10);
    const std::vector<Vec3> points = random_points(20000, 11, 2);
    auto measure = [&](std::size_t threads) {
        tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return points_to_mesh(points, mesh);
    };
    const Distance one = measure(1), many = measure(4);
    CHECK(one.max == many.max);
    CHECK(one.mean == many.mean);
    CHECK(one.rms == many.rms);
    CHECK(one.farthest == many.farthest);
}

TEST_CASE("no facet means infinitely far, no point means zero", "[distance]") {
    PolygonMesh empty;
    CHECK(std::isinf(MeshDistance(empty)(Vec3(1, 2, 3))));
    Index hint = no_index;
    CHECK(MeshDistance(empty).is_beyond(Vec3(1, 2, 3), 1e9, hint));
    const std::vector<Vec3> one{{1, 2, 3}};
    CHECK(std::isinf(points_to_mesh(one, empty).max));
    CHECK(points_to_mesh({}, random_triangles(3, 1)).max == 0);
    CHECK(sample_surface(empty, 10).empty());
}

TEST_CASE("surface samples lie on the mesh, in proportion to its area", "[distance]") {
    PolygonMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {4, 0, 0}, {4, 1, 0}};
    mesh.add_facet(std::array<Index, 4>{0, 1, 2, 3});
    mesh.add_facet(std::array<Index, 4>{1, 4, 5, 2}); // three times the area of the first
    const std::vector<Vec3> samples = sample_surface(mesh, 4000);
    REQUIRE(samples.size() == 4000);
    const auto first = std::count_if(samples.begin(), samples.end(), [](const Vec3& p) { return p[0] < 1; });
    CHECK(first == Approx(1000).margin(5));
    CHECK(points_to_mesh(samples, mesh).max < 1e-15);
    const auto low = std::count_if(samples.begin(), samples.end(), [](const Vec3& p) { return p[1] < 0.25; });
    CHECK(low == Approx(1000).margin(60));
    CHECK(sample_surface(mesh, 4000) == samples);
}

namespace {

/// Quads over a grid of unit steps, their corners off by up to `rough` in every direction.
PolygonMesh crumpled_sheet(Index side, double rough, unsigned seed, const Vec3& at) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> off(-rough, rough);
    return support::quad_sheet(side, side, [&](Index k, Index i) {
        return at + Vec3(i + off(random), k + off(random), off(random));
    });
}

} // namespace

TEST_CASE("points farther than asked are counted, and the first of them is told", "[distance]") {
    const PolygonMesh mesh = crumpled_sheet(20, 0.1, 13, {-7, 0.5, 0});
    std::vector<Vec3> points;
    for (const Vec3& p : random_points(5000, 14, 1))
        points.push_back(Vec3(3 + 9 * p[0], 10.5 + 9 * p[1], 2 * p[2]));
    const MeshDistance single(mesh);
    for (const double beyond : {0.0, 0.5, 1.0, 10.0}) {
        std::size_t count = 0, first = 0;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (single(points[i]) > beyond && count++ == 0) first = i;
        for (const Distance& distance :
             {points_to_mesh(points, mesh, {.beyond = beyond}),
              points_to_mesh(points, mesh, {.enough = beyond, .beyond = beyond}),
              points_to_mesh_by_cells(points, mesh, FacetCells(mesh, 1), beyond)}) {
            CHECK(distance.beyond == count);
            CHECK(distance.first_beyond == first);
        }
    }
}

TEST_CASE("cells find the same distances as the tree, whatever their size", "[distance]") {
    for (const double rough : {0.0, 0.3, 1.0}) {
        PolygonMesh mesh = crumpled_sheet(20, rough, 17, {-7, 0.5, 0});
        mesh.positions[50] = mesh.positions[51] = mesh.positions[52]; // facets without area
        std::vector<Vec3> points;
        for (const double near : {0.02, 0.5, 3.0}) // within a cell, in the next one, beyond
            for (const Vec3& p : random_points(700, 18, 1))
                points.push_back(Vec3(3 + 10 * p[0], 10.5 + 10 * p[1], near * p[2]));
        const MeshDistance single(mesh);
        const Distance by_tree = points_to_mesh(points, mesh);
        for (const double cell : {1.0, 1.7, 4.0}) CHECK(FacetCells(mesh, cell).usable());
        for (const double cell : {0.01, 0.7, 1.0, 1.7, 4.0, 100.0, 0.0, -1.0}) {
            const Distance by_cells = points_to_mesh_by_cells(points, mesh, FacetCells(mesh, cell));
            CHECK(by_cells.max == Approx(by_tree.max).epsilon(1e-12));
            CHECK(by_cells.mean == Approx(by_tree.mean).epsilon(1e-12));
            CHECK(by_cells.farthest == by_tree.farthest);
        }
        for (std::size_t i = 0; i < points.size(); i += 20) {
            const Distance alone = points_to_mesh_by_cells({&points[i], 1}, mesh, FacetCells(mesh, 1));
            CHECK(alone.max == Approx(single(points[i])).epsilon(1e-9).margin(1e-12));
        }
    }
}

TEST_CASE("cells measure triangles of all shapes, also those that lie in the walls between them",
          "[distance]") {
    PolygonMesh mesh = random_triangles(400, 19);
    for (Vec3& p : mesh.positions)
        if (std::abs(p[0]) < 0.3) p[0] = 0.25; // a wall
    std::vector<Vec3> points = random_points(2000, 20, 1.2);
    for (std::size_t i = 0; i < points.size(); i += 3) points[i][0] = 0.25;
    const Distance by_tree = points_to_mesh(points, mesh);
    for (const double cell : {0.25, 0.5}) {
        const Distance by_cells = points_to_mesh_by_cells(points, mesh, FacetCells(mesh, cell));
        CHECK(by_cells.max == Approx(by_tree.max).epsilon(1e-12));
        CHECK(by_cells.rms == Approx(by_tree.rms).epsilon(1e-12));
        tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        CHECK(points_to_mesh_by_cells(points, mesh, FacetCells(mesh, cell)).rms == by_cells.rms);
    }
    CHECK(FacetCells(mesh, 0.5).usable());
    CHECK(points_to_mesh_by_cells({}, mesh, FacetCells(mesh, 1)).max == 0);
    CHECK(std::isinf(points_to_mesh_by_cells(points, {}, FacetCells(PolygonMesh(), 1)).max));
}

TEST_CASE("cells pass over facets without corners, and over those that are nowhere", "[distance]") {
    PolygonMesh mesh = crumpled_sheet(8, 0.2, 21, {0, 0, 0});
    const std::vector<Vec3> points = random_points(200, 22, 8);
    const double expected = points_to_mesh_by_cells(points, mesh, FacetCells(mesh, 1)).max;
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Vec3& p : {Vec3(nan, nan, nan), Vec3(nan, 1, 1)}) {
        PolygonMesh broken = mesh;
        const auto first = static_cast<Index>(broken.vertex_count());
        for (int i = 0; i < 3; ++i) broken.positions.push_back(p);
        broken.add_facet(std::array<Index, 3>{first, first + 1, first + 2});
        broken.add_facet({});
        broken.add_facet(std::array<Index, 2>{0, 1});
        CHECK(FacetCells(broken, 1).usable());
        CHECK(points_to_mesh_by_cells(points, broken, FacetCells(broken, 1)).max == expected);
        CHECK(find_self_intersections(broken, FacetCells(broken, 1)).facet_pairs
              == find_self_intersections(mesh, FacetCells(mesh, 1)).facet_pairs);
    }
}

TEST_CASE("cells that hold crowds of facets are not used", "[distance]") {
    const PolygonMesh mesh = crumpled_sheet(60, 0.2, 23, {0, 0, 0});
    CHECK(FacetCells(mesh, 1).usable());
    CHECK_FALSE(FacetCells(mesh, 30).usable());
    CHECK_FALSE(FacetCells(mesh, 0.1).usable());
}
