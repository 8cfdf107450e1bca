#include "hsdm/simplify/developable_regions.hh"
#include "simplify/grids.hh"

#include <catch2/catch.hpp>

#include <numbers>

using namespace hsdm;
using support::arc;
using support::grid;

namespace {

std::vector<DevelopableRegion> regions_of(const PolygonMesh& mesh) {
    return find_developable_regions(facet_field(mesh), std::vector<Index>(mesh.facet_count(), no_index));
}

/// How many regions each facet is in.
std::vector<int> uses(const std::vector<DevelopableRegion>& regions, std::size_t facets) {
    std::vector<int> count(facets, 0);
    for (const DevelopableRegion& region : regions)
        for (Index f : region.facets) ++count[f];
    return count;
}

/// A wave: an arc to one side, then one to the other.
PolygonMesh wave() {
    return grid(100, 30, [](double u, double v) {
        const double a = 1.2 * (u < 0.5 ? 4 * u - 1 : 4 * (u - 0.5) - 1);
        const double x = u < 0.5 ? std::sin(a) : 2 * std::sin(1.2) + std::sin(a);
        const double z = u < 0.5 ? std::cos(a) : 2 * std::cos(1.2) - std::cos(a);
        return Vec3(x, 2 * v, z);
    });
}

} // namespace

TEST_CASE("a cylinder is one region with its own axis", "[simplify]") {
    for (const bool inside : {false, true}) {
        const PolygonMesh mesh = inside ? support::reversed(arc(1, 1.8, 0, 60, 30)) : arc(1, 1.8, 0, 60, 30);
        const std::vector<DevelopableRegion> regions = regions_of(mesh);
        REQUIRE(regions.size() == 1);
        CHECK(regions[0].facets.size() == mesh.facet_count());
        CHECK(std::abs(regions[0].axis.direction[1]) == Approx(1).margin(1e-4));
        CHECK(regions[0].axis.cosine == 0);
        CHECK(regions[0].axis.deviation < 0.01);
        CHECK(regions[0].convex == !inside);
    }
}

TEST_CASE("along a cone normals have one angle to its axis", "[simplify]") {
    const double narrowing = 0.5;
    const PolygonMesh mesh = arc(1, 1.8, narrowing, 90, 50);
    const std::vector<DevelopableRegion> regions = regions_of(mesh);
    REQUIRE(regions.size() == 1);
    CHECK(20 * regions[0].facets.size() > 19 * mesh.facet_count());
    const Axis& axis = regions[0].axis;
    CHECK(std::abs(axis.direction[1]) == Approx(1).margin(1e-3));
    // Normals lean by the slope of a side.
    CHECK(std::abs(axis.cosine) == Approx(narrowing / std::sqrt(1 + narrowing * narrowing)).margin(0.01));
    CHECK((axis.cosine > 0) == (axis.direction[1] > 0));
}

TEST_CASE("where a wave turns its other side up another region begins", "[simplify]") {
    const PolygonMesh mesh = wave();
    const std::vector<DevelopableRegion> regions = regions_of(mesh);
    REQUIRE(regions.size() == 2);
    CHECK(regions[0].convex != regions[1].convex);
    const std::vector<int> count = uses(regions, mesh.facet_count());
    CHECK(*std::max_element(count.begin(), count.end()) == 1);
    CHECK(10 * std::count(count.begin(), count.end(), 1) > 9 * std::ssize(count));
    for (const DevelopableRegion& region : regions) {
        CHECK(std::abs(region.axis.direction[1]) > 0.999);
        for (Index f : region.facets) // but for those at the turn, which feel both
            if (f % 100 < 46 || f % 100 > 53) CHECK((f % 100 < 50) == region.convex);
    }
}

TEST_CASE("facets that are taken are in no region", "[simplify]") {
    const PolygonMesh mesh = arc(1, 1.8, 0, 60, 30);
    std::vector<Index> taken(mesh.facet_count(), no_index);
    for (Index f = 0; f < taken.size(); ++f)
        if (f % 60 >= 28 && f % 60 < 32) taken[f] = 7; // a row of them cuts it in two
    const std::vector<DevelopableRegion> regions = find_developable_regions(facet_field(mesh), taken);
    REQUIRE(regions.size() == 2);
    const std::vector<int> count = uses(regions, mesh.facet_count());
    for (Index f = 0; f < taken.size(); ++f) CHECK(count[f] == (taken[f] == no_index ? 1 : 0));
    for (const DevelopableRegion& region : regions)
        for (Index f : region.facets) CHECK((f % 60 < 30) == (region.facets[0] % 60 < 30));
}

TEST_CASE("no region begins at a facet that is taken", "[simplify]") {
    const PolygonMesh mesh = arc(1, 1.8, 0, 60, 30);
    std::vector<Index> taken(mesh.facet_count(), no_index);
    for (Index f = 0; f < taken.size(); f += 7) taken[f] = 0;
    const std::vector<int> count =
        uses(find_developable_regions(facet_field(mesh), taken), mesh.facet_count());
    for (Index f = 0; f < taken.size(); ++f) CHECK(count[f] == (taken[f] == no_index ? 1 : 0));
    taken.assign(taken.size(), 0);
    CHECK(find_developable_regions(facet_field(mesh), taken).empty());
}

TEST_CASE("of a bent tube a region is what has one axis: all where it hardly bends", "[simplify]") {
    for (const double ring : {12.0, 40.0, 60.0, 200.0}) {
        INFO("bent with a radius of " << ring);
        const PolygonMesh mesh = grid(60, 60, [ring](double u, double v) {
            const double turn = 3 * (v - 0.5) / ring, r = ring + std::sin(1.8 * u);
            return Vec3(r * std::cos(turn), r * std::sin(turn), std::cos(1.8 * u));
        });
        const FacetField field = facet_field(mesh);
        std::size_t most = 0;
        for (const DevelopableRegion& region : regions_of(mesh)) {
            double squares = 0, weight = 0;
            for (Index f : region.facets) {
                const double off = (region.axis.direction | field.mean_normal[f]) - region.axis.cosine;
                squares += off * off * field.area[f].norm();
                weight += field.area[f].norm();
            }
            CHECK(std::sqrt(squares / weight) < 0.0101);
            CHECK(region.axis.deviation == Approx(std::sqrt(squares / weight)).margin(1e-4));
            most = std::max(most, region.facets.size());
        }
        CHECK((most == mesh.facet_count()) == (ring == 200));
    }
}

TEST_CASE("what bends two ways, and what has few facets, is no region", "[simplify]") {
    CHECK(regions_of(grid(40, 40, [](double u, double v) {
              const double x = u - 0.5, y = v - 0.5;
              return Vec3(x, y, std::sqrt(1.5 - x * x - y * y));
          })).empty());
    CHECK(regions_of(grid(40, 40, [](double u, double v) {
              const double x = u - 0.5, y = v - 0.5;
              return Vec3(x, y, 0.5 * (x * x - y * y)); // a saddle
          })).empty());
    CHECK(regions_of(arc(1, 0.5, 0, 10, 5)).empty()); // of 50 facets
    CHECK(regions_of(arc(1, 0.5, 0, 10, 7)).size() == 1);
    CHECK(regions_of(PolygonMesh()).empty());
}

TEST_CASE("a region ends at a sharp edge", "[simplify]") {
    // Two arcs of a radian each round axes along y, with an edge of 60 degrees between them.
    const PolygonMesh mesh = grid(80, 30, [](double u, double v) {
        constexpr double edge = std::numbers::pi / 3;
        if (std::abs(u - 0.5) < 0.5 / 80) u = 0.5; // there the grid is not torn
        if (u <= 0.5) return Vec3(std::sin(2 * u), 2 * v, std::cos(2 * u));
        const Vec3 start(std::sin(1) - std::sin(1 + edge), 0, std::cos(1) - std::cos(1 + edge));
        return Vec3(std::sin(2 * u + edge), 2 * v, std::cos(2 * u + edge)) + start;
    });
    const std::vector<DevelopableRegion> regions = regions_of(mesh);
    REQUIRE(regions.size() == 2);
    for (const DevelopableRegion& region : regions) {
        CHECK(region.facets.size() == 40 * 30);
        const bool left = region.facets[0] % 80 < 40;
        CHECK(std::all_of(region.facets.begin(), region.facets.end(),
                          [left](Index f) { return (f % 80 < 40) == left; }));
    }
}
