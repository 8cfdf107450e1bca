#include "hsdm/mesh/area_vector.hh"
#include "hsdm/simplify/strips.hh"
#include "simplify/grids.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <numbers>

using namespace hsdm;
using support::arc;

namespace {

constexpr double angle = 1.8;

/// A sheet that is one region.
struct Bent {
    PolygonMesh mesh;
    FacetField field;
    DevelopableRegion region;

    explicit Bent(PolygonMesh sheet) : mesh(std::move(sheet)), field(facet_field(mesh)) {
        auto regions = find_developable_regions(field, std::vector<Index>(mesh.facet_count(), no_index));
        REQUIRE(regions.size() == 1);
        region = std::move(regions[0]);
    }
    Bent(const Bent&) = delete; // the field refers to the mesh

    std::optional<Strips> cut(double tolerance) const { return cut_to_strips(field, region, tolerance); }
    double height(const Strips& strips, std::size_t i) const {
        return strips.planes[strips.of[i]].height(field.centre[region.facets[i]]);
    }
};

/// Chords of an arc of radius 1 that keep within a tolerance to either side.
double needed(double all, double tolerance) {
    return all / std::sqrt(16 * tolerance);
}

} // namespace

TEST_CASE("strips are as few as keep their facets within the tolerance", "[simplify]") {
    const Bent bent(arc(1, angle, 0, 120, 40));
    std::size_t before = 0;
    for (const double tolerance : {0.05, 0.02, 0.005, 0.002}) {
        INFO("tolerance " << tolerance);
        const std::optional<Strips> strips = bent.cut(tolerance);
        REQUIRE(strips);
        REQUIRE(strips->of.size() == bent.region.facets.size());
        const std::size_t count = strips->planes.size();
        CHECK(static_cast<double>(count) > needed(angle, tolerance) - 0.1);
        CHECK(static_cast<double>(count) <= needed(angle, tolerance) + 2);
        CHECK(count > before);
        before = count;
        REQUIRE(*std::max_element(strips->of.begin(), strips->of.end()) < count);
        double highest = 0, lowest = 0;
        for (std::size_t i = 0; i < strips->of.size(); ++i) {
            highest = std::max(highest, bent.height(*strips, i));
            lowest = std::min(lowest, bent.height(*strips, i));
        }
        CHECK(highest < 1.2 * tolerance); // a strip's middle, and its margins
        CHECK(lowest > -1.2 * tolerance);
        CHECK(highest > 0.4 * -lowest);
        CHECK(-lowest > 0.4 * highest);
    }
}

TEST_CASE("strips lie along the rulings, one after the other, and are about as wide", "[simplify]") {
    const Bent bent(arc(1, angle, 0, 120, 40));
    const std::optional<Strips> strips = bent.cut(0.005);
    REQUIRE(strips);
    std::vector<double> area(strips->planes.size(), 0), least(area.size(), 10), most(area.size(), -10);
    for (std::size_t i = 0; i < strips->of.size(); ++i) {
        const Index f = bent.region.facets[i], strip = strips->of[i];
        const double turn = std::atan2(bent.field.centre[f][0], bent.field.centre[f][2]);
        least[strip] = std::min(least[strip], turn);
        most[strip] = std::max(most[strip], turn);
        area[strip] += bent.field.area[f].norm();
    }
    for (const Plane& plane : strips->planes) {
        CHECK(std::abs(plane.normal[1]) < 0.01);
        CHECK(plane.normal.norm() == Approx(1));
    }
    CHECK(*std::max_element(area.begin(), area.end()) < 1.3 * *std::min_element(area.begin(), area.end()));
    for (std::size_t k = 0; k < area.size(); ++k)
        for (std::size_t l = 0; l < k; ++l) {
            const bool after = least[k] > least[l];
            const double overlap = after ? most[l] - least[k] : most[k] - least[l];
            CHECK(overlap < 2 * angle / 120); // a facet's width, torn as the grid is
        }
}

TEST_CASE("planes of neighbouring strips meet where one takes over from the other", "[simplify]") {
    const Bent bent(support::grid(120, 40, [](double u, double v) { // of an ellipse
        return Vec3(3 * std::sin(angle * u), 2 * v, std::cos(angle * u));
    }));
    const std::optional<Strips> strips = bent.cut(0.01);
    REQUIRE(strips);
    double most = 0;
    for (std::size_t i = 0; i < strips->of.size(); ++i) {
        const Vec3& centre = bent.field.centre[bent.region.facets[i]];
        for (const Plane& other : strips->planes)
            if ((other.normal | strips->planes[strips->of[i]].normal) > 0.7)
                most = std::max(most, other.height(centre) - bent.height(*strips, i));
    }
    CHECK(most < 0.002);
}

TEST_CASE("strips of the inside of a cylinder bulge the other way", "[simplify]") {
    const Bent outside(arc(1, angle, 0, 120, 40)), inside(support::reversed(arc(1, angle, 0, 120, 40)));
    const std::optional<Strips> one = outside.cut(0.01), other = inside.cut(0.01);
    REQUIRE((one && other));
    CHECK(one->planes.size() == other->planes.size());
    for (const Plane& plane : other->planes) {
        CHECK(plane.offset < 0); // faces the axis
        const auto same = [&](const Plane& p) {
            return (p.normal + plane.normal).norm() < 0.02 && std::abs(p.offset + plane.offset) < 0.002;
        };
        CHECK(std::any_of(one->planes.begin(), one->planes.end(), same));
    }
}

TEST_CASE("strips go all the way round a shaft", "[simplify]") {
    const Bent bent(support::round_tube(120, 30, 1, 0.05));
    const std::optional<Strips> strips = bent.cut(0.01);
    REQUIRE(strips);
    CHECK(static_cast<double>(strips->planes.size()) >= needed(2 * std::numbers::pi, 0.01));
    CHECK(static_cast<double>(strips->planes.size()) <= needed(2 * std::numbers::pi, 0.01) + 5);
    Vec3 sum(0, 0, 0);
    for (const Plane& plane : strips->planes) sum += plane.normal;
    CHECK(sum.norm() < 0.05 * static_cast<double>(strips->planes.size()));
    double farthest = 0;
    for (std::size_t i = 0; i < strips->of.size(); ++i)
        farthest = std::max(farthest, std::abs(bent.height(*strips, i)));
    CHECK(farthest < 0.013);
}

TEST_CASE("strips narrower than a facet are none", "[simplify]") {
    const Bent bent(arc(1, angle, 0, 24, 40));
    CHECK(bent.cut(0.01));
    CHECK_FALSE(bent.cut(1e-5));
}

TEST_CASE("on a cone strips lean as its sides do and narrow with it", "[simplify]") {
    const double narrowing = 0.5, slope = narrowing / std::sqrt(1 + narrowing * narrowing);
    const Bent bent(arc(1, angle, narrowing, 120, 60));
    const std::optional<Strips> strips = bent.cut(0.01);
    REQUIRE(strips);
    for (const Plane& plane : strips->planes) CHECK(plane.normal[1] == Approx(slope).margin(0.02));
}
